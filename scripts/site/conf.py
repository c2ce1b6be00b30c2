# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Sphinx's configuration of the site. scripts/build_site.sh puts this file beside
# the pages, and sets SITE_VERSION.

import os

project = "cartographer_sdf"
author = "The cartographer_sdf authors"
version = release = os.environ.get("SITE_VERSION", "")  # With the commit.
project_copyright = f"2026 The cartographer_sdf authors, Apache-2.0. Version {version}"

extensions = ["myst_parser", "sphinx_copybutton"]
highlight_language = "none"
smartquotes = False  # Flags begin with two hyphens.
myst_enable_extensions = ["deflist"]
# The same anchors as in a browser of the repository.
myst_heading_anchors = 4

html_theme = "furo"
html_title = f"cartographer_sdf {version.partition(' ')[0]}".strip()
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None
html_theme_options = {"navigation_with_keys": True}
# A command can be copied without its prompt and its output.
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
pygments_style = "tango"
pygments_dark_style = "native"
