# SPDX-License-Identifier: Apache-2.0
"""The demo's page: one HTML file that holds its pictures and needs no other file."""
import base64
import html as html_escape
import pathlib

STYLE = (pathlib.Path(__file__).parent / "page.css").read_text()


def escaped(text):
    return html_escape.escape(str(text))


def picture(path, title):
    """A drawing on a white background, as drawings are black lines on nothing."""
    data = base64.b64encode(path.read_bytes()).decode()
    kind, paper = ("svg+xml", ' class="paper"') if path.suffix == ".svg" else ("png", "")
    return f'<img{paper} src="data:image/{kind};base64,{data}" alt="{escaped(title)}" loading="lazy">'


NO_BREAK = "\u00a0"


def milliseconds(value):
    return f"{value:.0f}{NO_BREAK}ms" if value >= 10 else f"{value:.1f}{NO_BREAK}ms"


def timings(result):
    """"whole process 62 ms · visible 3.1 ms · ..." from the program's own report."""
    parts = [f"whole process {milliseconds(result.wall_ms)}"]
    found = result.report.get("timings_ms", {})
    for name in ("load", "surfaces", "visible", "shade", "save", "lines", "strokes", "tones", "write"):
        value = found.get(name)
        if isinstance(value, dict):
            value = value.get("median")
        if value is not None:
            parts.append(f"{name} {milliseconds(value)}")
    return " · ".join(parts)


def command(result):
    """The command, wrapped between words and not at the hyphens of options."""
    words = f"frontmost {result.show.command} {result.show.arguments}".split(" ")
    return f'<pre><code>{" ".join(f"""<span class="word">{escaped(word)}</span>""" for word in words)}</code></pre>'


def links(files):
    return ", ".join(
        f'<a href="{escaped(f.name)}">{escaped(f.name)}</a> <span class="size">{f.stat().st_size / 1024:.0f}{NO_BREAK}KiB</span>'
        for f in dict.fromkeys(files))


def card(result):
    show = result.show
    others = f"<p>{links(result.files)}</p>" if len(result.files) > 1 else ""
    body = f"""<figcaption><h3>{escaped(show.title)}</h3><p>{escaped(show.caption)}</p>
{command(result)}{others}<p class="time">{escaped(timings(result))}</p></figcaption>"""
    kind = "card wide" if show.wide else "card"
    return f'<figure class="{kind}">{picture(result.files[0], show.title)}{body}</figure>'


def file_rows(result):
    return f"""<div class="row"><h3>{escaped(result.show.title)}</h3><p>{escaped(result.show.caption)}</p>
{command(result)}<p>{links(result.files)}</p><p class="time">{escaped(timings(result))}</p></div>"""


def section(words, results):
    only_files = all(result.show.files[0][-4:] not in (".png", ".svg") or "--depth " in result.show.arguments for result in results)
    body = "".join(map(file_rows if only_files else card, results))
    kind = "rows" if only_files else "cards"
    return f'<section><h2>{escaped(words.title)}</h2><p>{escaped(words.words)}</p><div class="{kind}">{body}</div></section>'


def hashes(rows):
    if not rows:
        return ""
    lines = "".join(f"<tr><td><code>{escaped(how)}</code></td><td><code>{escaped(found)}</code></td></tr>" for how, found in rows)
    equal = len({found for _, found in rows}) == 1
    verdict = "All equal." if equal else "They differ, and must not: please report this machine."
    return f"""<section><h2>The same bytes</h2><p>The hash of what is visible in <code>builtin:city</code>, by instruction
set and number of threads on this machine. {verdict}</p><table>{lines}</table></section>"""


def link_to(browser_page):
    """The page that runs the library in a browser, if it has been built."""
    if browser_page is None:
        return ""
    return f"""<p><a href="{escaped(browser_page)}">Turn your own model, and watch the methods at work, in this browser</a>; it is
to be served: <code>node scripts/page/server.mjs</code></p>"""


def html(sections, hash_rows, version, browser_page=None):
    hero, *rest = sections[0][1]
    words = sections[0][0]
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark"><title>Frontmost demo</title><style>
{STYLE}</style></head><body>
<header><h1>Frontmost</h1><p class="lead">What can be seen from here? Every picture on this page was made on this
machine a moment ago, without a GPU, a display or a driver. The command below a picture makes it again.</p>{link_to(browser_page)}</header>
<main>{card(hero)}{section(words, rest)}{"".join(section(*pair) for pair in sections[1:])}{hashes(hash_rows)}</main>
<footer>{escaped(version)}</footer></body></html>
"""
