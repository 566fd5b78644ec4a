"""How Sphinx makes the documentation site of the pages in docs/ and the comments of the interfaces (scripts/docs.sh, which
lays its sources out and says where they are)."""

import os
import re
from pathlib import Path

sources = Path(os.environ["LDSO_SOURCES"])

project = "ldso"
author = copyright = "the ldso authors"
release = version = re.search(r"project\(ldso VERSION ([0-9.]+)", (sources / "CMakeLists.txt").read_text()).group(1)

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
root_doc = "index"
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
myst_heading_anchors = 4
# Tables and lists of the pages are plain Markdown; `<!-- -->` comments are for scripts/check_docs.py.
myst_enable_extensions = ["colon_fence"]

breathe_projects = {"ldso": os.environ["LDSO_DOXYGEN"], "ldso_c": os.environ["LDSO_DOXYGEN_C"]}
breathe_default_project = "ldso"
breathe_show_include = False
breathe_domain_by_file_pattern = {"*/ldso.h": "c"}
# The attribute of exported functions, and Doxygen's own view of templates that Sphinx cannot parse.
c_id_attributes = ["LDSO_API"]

autodoc_default_options = {"members": True, "undoc-members": True, "member-order": "bysource"}
autodoc_class_signature = "separated"
add_module_names = False

# Everything that a page loads is within the site: it is read without a network.
html_theme = "furo"
html_title = f"ldso {version}"
html_static_path = ["_static"]
html_css_files = ["ldso.css"]
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False


def tidy_docstring(app, what, name, obj, options, lines):
    """pybind11 begins docstrings with the signature, which autodoc shows already, and says `ldso._ldso` for `ldso`."""
    if lines and re.match(r"[a-z_A-Z0-9]+\(.*\)( -> .*)?$", lines[0]):
        del lines[0]
    if what == "module":
        del lines[1:]  # Its example stands in docs/python.md, formatted.
    lines[:] = [line.replace("ldso._ldso.", "ldso.") for line in lines]


def tidy_signature(app, what, name, obj, options, signature, returns):
    shorten = lambda text: text and text.replace("ldso._ldso.", "")
    return shorten(signature), shorten(returns)


def setup(app):
    app.connect("autodoc-process-docstring", tidy_docstring)
    app.connect("autodoc-process-signature", tidy_signature)
