# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Sphinx reads this from docs/site; the pages are those that stage.py has laid out (see docs/site.md).
import os
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing is left beside the sources
here = Path(__file__).parent
sys.path.insert(0, str(here))
out = Path(os.environ["TRUSSMAP_SITE"])  # build/site

project = "trussmap"
copyright = "2026, the trussmap authors"
author = "the trussmap authors"
release = re.search(r"project\(trussmap\s+VERSION\s+([0-9.]+)",
                    (here.parents[1] / "CMakeLists.txt").read_text())[1]
version = release

extensions = ["myst_parser", "breathe", "katex_math", "cpp_links"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["files"]
highlight_language = "none"
toc_object_entries = False  # a thousand declarations in the sidebar of every page

breathe_projects = {"trussmap": str(out / "doxygen" / "xml")}
breathe_default_project = "trussmap"
breathe_domain_by_extension = {"hpp": "cpp"}
primary_domain = "cpp"

html_theme = "furo"
html_title = f"trussmap {release}"
html_static_path = [str(here / "static"), str(out / "static")]
html_css_files = ["katex.min.css", "site.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": True}
