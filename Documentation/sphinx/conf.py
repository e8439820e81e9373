# SPDX-License-Identifier: GPL-2.0-only
"""Settings of Sphinx for "make doc", which runs it on a copy of Documentation/."""
project = "EtherCAT master"
copyright = "its authors"       # noqa: A001, the name is Sphinx's
html_theme = "alabaster"
html_theme_options = {"description": "EtherCAT master for Linux", "fixed_sidebar": True}
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_show_sourcelink = False
html_copy_source = False
highlight_language = "none"     # blocks are commands with their output
primary_domain = "c"
smartquotes = False             # options are typed as they are shown
nitpicky = False
