# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Names of types in declarations lead to where they are declared. Sphinx's own search goes through
# all symbols for every name, which takes minutes; here a table is made once. Each type's name is
# unique in the library, and what is not in the table (std, Eigen) is plain text.
from sphinx.addnodes import pending_xref
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util.nodes import make_refnode

TYPES = ("class", "struct", "union", "enum", "type", "concept")
table = None


def places(env):
    global table
    if table is None:
        table = {}
        for symbol in env.get_domain("cpp").data["root_symbol"].get_all_symbols():
            declaration = symbol.declaration
            if declaration is not None and symbol.docname and declaration.objectType in TYPES:
                name = str(symbol.get_full_nested_name()).split("::")[-1]
                table.setdefault(name, (symbol.docname, declaration.get_newest_id()))
    return table


class LinkTypes(SphinxPostTransform):
    default_priority = 5  # before Sphinx's own

    def run(self, **kwargs):
        for node in list(self.document.findall(pending_xref)):
            if node.get("refdomain") != "cpp":
                continue
            place = places(self.env).get(node["reftarget"].split("::")[-1])
            if place is None:
                node.replace_self(node.children)
            else:
                node.replace_self(make_refnode(self.app.builder, self.env.docname, *place,
                                               node.children, None))


def setup(app):
    app.add_post_transform(LinkTypes)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
