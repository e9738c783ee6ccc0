"""Finds links of the built book that lead nowhere: `docs/links.py FOLDER` prints them, and fails if there is one."""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The places of a page that can be gone to, and where it leads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.places: set[str] = set()
        self.links: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.places.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def dead(book: Path) -> list[str]:
    """Links inside of the book whose page or place is not there."""
    # These repeat the others: all pages in one, and the list of contents.
    copies = {"print.html", "toc.html", "404.html"}
    pages = {path: Page(path.read_text("utf-8")) for path in book.rglob("*.html")}
    found = []
    for path, page in pages.items():
        if path.name in copies:
            continue
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = path
            if parts.path:
                target = (path.parent / unquote(parts.path)).resolve()
            if target.is_dir():
                target = target / "index.html"
            place = unquote(parts.fragment)
            if not target.is_file() or (place and target in pages and place not in pages[target].places):
                found.append(f"{path.relative_to(book)}: {link}")
    return found


if __name__ == "__main__":
    lines = dead(Path(sys.argv[1]).resolve())
    print("\n".join(lines), end="\n" if lines else "")
    sys.exit(f"{len(lines)} links lead nowhere" if lines else 0)
