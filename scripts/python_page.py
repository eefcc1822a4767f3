#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the second half of docs/python.md: every call of the Python module, in the words of its stubs.

    python_page.py update    writes the page
    python_page.py check     reports whether the page is up to date
"""
import ast
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
STUBS = ROOT / "python" / "frontmost" / "__init__.pyi"
PAGE = ROOT / "docs" / "python.md"
MARK = "## Every call\n"


def signature(node, name):
    arguments = [a.arg for a in node.args.args if a.arg != "self"]
    defaults = [None] * (len(arguments) - len(node.args.defaults)) + node.args.defaults[-len(arguments) or None:]
    shown = [a if d is None else f"{a}={default(d)}" for a, d in zip(arguments, defaults)]
    if node.args.kwonlyargs:
        shown.append("*")
        shown += [a.arg if d is None else f"{a.arg}={default(d)}"
                  for a, d in zip(node.args.kwonlyargs, node.args.kw_defaults)]
    given = "" if node.returns is None else ast.unparse(node.returns)
    return f"{name}({', '.join(shown)})" + (f" -> {plain(given)}" if given not in ("", "None") else "")


def default(node):
    return {"...": "..."}.get(ast.unparse(node)) or ast.unparse(node).replace("'", '"')


def plain(annotation):
    """NDArray[numpy.float32] | None -> float32 array or None"""
    text = re.sub(r"NDArray\[(?:numpy\.)?(\w+)\]", r"\1 array", annotation)
    return text.replace(" | ", " or ").replace("bool_ array", "bool array")


def words(node):
    text = ast.get_docstring(node)
    return re.sub(r"\s+", " ", text or "").strip()


def members(tree, prefix):
    for node, follower in zip(tree.body, [*tree.body[1:], None]):
        if isinstance(node, ast.AnnAssign) and isinstance(follower, ast.Expr):
            yield f"- `{prefix}{node.target.id}`: {follower.value.value}"
        if not isinstance(node, ast.FunctionDef) or (node.name.startswith("_") and node.name != "__init__"):
            continue
        is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)
        if is_property:
            yield f"- `{prefix}{node.name}` ({plain(ast.unparse(node.returns))}): {words(node)}"
        elif node.name == "__init__":
            yield f"- `{signature(node, prefix[:-1]).split(' -> ')[0]}`"
        else:
            yield f"- `{signature(node, prefix + node.name)}`: {words(node)}"


def page():
    tree = ast.parse(STUBS.read_text())
    lines = []
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            inside = list(members(node, f"{node.name}."))
            lines += [f"### {node.name}", "", words(node), "", *inside, *[""] * bool(inside)]
        elif isinstance(node, ast.FunctionDef):
            lines += [f"### {node.name}", "", f"`{signature(node, node.name)}`", "", words(node), ""]
    lines += ["### Numbers", "", "`no_primitive` and `no_index` (both 4294967295) are what ids hold where there is nothing; the words that "
              "small numbers in arrays stand for are `edge_kinds` (Drawing.kind), `object_sights` (Occlusion.cull()), "
              "`difference_kinds` (Agreement.differences) and `fight_kinds` (FightAreas).", ""]
    head = PAGE.read_text().split(MARK)[0]
    return head + MARK + "\n" + "\n".join(lines).rstrip() + "\n"


def main():
    wanted = page()
    if sys.argv[1:] == ["update"]:
        PAGE.write_text(wanted)
    elif sys.argv[1:] != ["check"]:
        sys.exit(__doc__)
    elif PAGE.read_text() != wanted:
        sys.exit("docs/python.md is not in the words of the stubs: python3 scripts/python_page.py update")


if __name__ == "__main__":
    main()
