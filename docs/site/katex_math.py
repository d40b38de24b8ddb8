# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Formulas are set when the site is built (KaTeX, run by node), so that pages need no script and no
# network for them.
import json
import subprocess

KATEX = "/usr/share/javascript/katex/katex.min.js"
SCRIPT = """
const katex = require(process.argv[1]);
const {text, display} = JSON.parse(require('fs').readFileSync(0, 'utf8'));
process.stdout.write(katex.renderToString(text, {displayMode: display, throwOnError: true}));
"""
known = {}


def formula(text, display):
    key = (text, display)
    if key not in known:
        ran = subprocess.run(["node", "-e", SCRIPT, KATEX], text=True, capture_output=True,
                             input=json.dumps({"text": text, "display": display}))
        if ran.returncode != 0:
            raise RuntimeError(f"formula {text!r}: {ran.stderr.strip()[-400:]}")
        known[key] = ran.stdout
    return known[key]


def inline(self, node):
    from docutils import nodes
    self.body.append(formula(node.astext(), False))
    raise nodes.SkipNode


def block(self, node):
    from docutils import nodes
    self.body.append(f'<div class="formula">{formula(node.astext(), True)}</div>')
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("katex", (inline, None), (block, None))
    app.config.html_math_renderer = "katex"
    return {"parallel_read_safe": True, "parallel_write_safe": True}
