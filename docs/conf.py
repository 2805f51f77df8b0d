# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The manual: `make docs`. Its pages stay where what they describe is; the repository is the source folder."""

import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "tests" / "programs" / "guide")]

project = "uel"
copyright = "The uel-harness authors"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathematics", "generated"]

root_doc = "docs/index"
include_patterns = [
    "docs/**.md",
    "*.md",
    "fortran/*.md",
    "harness/uel/**.md",
    "abaqus_inputs/**.md",
]
# the README says in short what the manual says
exclude_patterns = ["harness/uel/project/template", "README.md"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
# pages also serve readers of the repository, whose links are paths
myst_all_links_external = False
# a page that no list has is found by its links
suppress_warnings = ["myst.header", "toc.not_included"]

autodoc_typehints = "description"
autodoc_member_order = "bysource"
nitpicky = False

# the folder of the site begins at the manual
html_extra_path = ["index.html"]
html_theme = "furo"
html_title = "uel"
html_static_path = ["static"]
html_css_files = ["uel.css"]
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True}
