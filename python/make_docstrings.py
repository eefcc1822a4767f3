# SPDX-License-Identifier: Apache-2.0
"""Makes the docstrings of the compiled part out of those of the stubs, so that each is written once.

    make_docstrings.py STUBS.pyi OUT.cpp
"""
import ast
import json
import pathlib
import sys


def docstrings(tree, prefix=""):
    """Yields (qualified name, docstring) of everything that has one; that of an attribute follows it."""
    for node, follower in zip(tree.body, [*tree.body[1:], None]):
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            text = ast.get_docstring(node)
            if text:
                yield prefix + node.name, text
            if isinstance(node, ast.ClassDef):
                yield from docstrings(node, f"{prefix}{node.name}.")
        elif isinstance(node, ast.AnnAssign) and isinstance(follower, ast.Expr):
            yield prefix + node.target.id, follower.value.value


def main():
    stubs, out = map(pathlib.Path, sys.argv[1:])
    known = {}
    for name, text in docstrings(ast.parse(stubs.read_text())):
        known.setdefault(name, text)
    lines = [f"      {{{json.dumps(name)}, {json.dumps(text)}}}," for name, text in sorted(known.items())]
    out.write_text("\n".join([
        "// Made from the stubs by make_docstrings.py.",
        "#include <map>",
        "#include <string_view>",
        "",
        "namespace frontmost::python {",
        "",
        "const char* doc(const char* name);",
        "",
        "const char* doc(const char* name) {",
        "  static const std::map<std::string_view, const char*> known = {",
        *lines,
        "  };",
        "  const auto found = known.find(name);",
        '  return found == known.end() ? "" : found->second;',
        "}",
        "",
        "}  // namespace frontmost::python",
        "",
    ]))


if __name__ == "__main__":
    main()
