"""The reliability diagram as an SVG, drawn by hand: no library, no script, and it stands in a page as it is."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from textwrap import wrap

from thermodata.chart.colour import FONT, light
from thermodata.virtual.blind.reliability import Reliability
from thermodata.virtual.blind.wording import SORTS

INK, MUTED, GRID, PAPER, MODEL, RESIDUAL = (
    light()[name] for name in ("ink", "muted", "grid", "paper", "model", "residual")
)
SIDE, LEFT, TOP, BELOW = 360, 62, 52, 132  # [px]
TITLE_WIDE = 48  # [letters]: more would stand beyond the edge
STRIP = 44  # height of the counts below
LOOK = {"first": (MODEL, -4), "claim": (RESIDUAL, 4)}  # colour, shift [px]


def diagram(found: Sequence[Reliability], title: str) -> str:
    """Share that came true against what was stated, with Wilson's intervals of 95 %, and how many stated what."""
    width, height = LEFT + SIDE + 24, TOP + SIDE + BELOW
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        f'font-family="{escape(FONT, quote=True)}" font-size="11">',
        f'<rect width="{width}" height="{height}" fill="{PAPER}"/>',
        *(_text(LEFT, 18 + 16 * i, line, size=13) for i, line in enumerate(wrap(title, TITLE_WIDE))),
        *_axes(),
    ]
    most = max((b.of for one in found for b in one.bins), default=1)
    for number, one in enumerate(found):
        colour, shift = LOOK[one.of]
        parts += _series(one, colour, shift, most)
        told = (
            f"{SORTS[one.of]}: {one.statements}, Brier {one.brier:.3f} (base rate {one.base_brier:.3f}), "
            f"calibration error {one.calibration_error:.3f}"
        )
        parts.append(_text(16, TOP + SIDE + BELOW - 22 + 14 * number, told, colour=colour))
    return "\n".join([*parts, "</svg>", ""])


def _x(p: float) -> float:
    return LEFT + SIDE * p


def _y(p: float) -> float:
    return TOP + SIDE * (1 - p)


def _axes() -> list[str]:
    parts = []
    for k in range(0, 11, 2):
        p = k / 10
        parts += [
            _line(_x(p), _y(0), _x(p), _y(1), GRID),
            _line(_x(0), _y(p), _x(1), _y(p), GRID),
            _text(_x(p), _y(0) + 16, f"{p:.0%}", anchor="middle", colour=MUTED),
            _text(_x(0) - 8, _y(p) + 4, f"{p:.0%}", anchor="end", colour=MUTED),
        ]
    middle = TOP + SIDE / 2
    return [
        *parts,
        _line(_x(0), _y(0), _x(1), _y(1), MUTED, dash=True),
        _text(_x(0.5), _y(0) + 34, "stated probability", anchor="middle"),
        f'<g transform="rotate(-90 16 {middle})">{_text(16, middle, "share that was right", anchor="middle")}</g>',
    ]


def _series(one: Reliability, colour: str, shift: float, most: int) -> list[str]:
    """Points with their intervals, and the counts as bars below, side by side with the other series."""
    floor = TOP + SIDE + 44 + STRIP
    parts = []
    for b in one.bins:
        x = _x(b.stated) + shift
        bar = max(STRIP * b.of / most, 1.0)
        parts += [
            _line(x, _y(b.low), x, _y(b.high), colour),
            f'<circle cx="{x:.1f}" cy="{_y(b.true):.1f}" r="4" fill="{colour}">'
            f"<title>{b.true:.0%} of {b.of} ({b.low:.0%}-{b.high:.0%}), stated {b.stated:.0%}</title></circle>",
            f'<rect x="{x - 3.5:.1f}" y="{floor - bar:.1f}" width="7" height="{bar:.1f}" fill="{colour}"/>',
            _text(
                x - shift / 2, floor - bar - 3, str(b.of), anchor="end" if shift < 0 else "start", colour=colour, size=9
            ),
        ]
    return parts


def _line(x0: float, y0: float, x1: float, y1: float, colour: str, dash: bool = False) -> str:
    broken = ' stroke-dasharray="4 4"' if dash else ""
    return f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" stroke="{colour}"{broken}/>'


def _text(x: float, y: float, text: str, anchor: str = "start", colour: str = INK, size: float = 11) -> str:
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-size="{size:g}">'
        f"{escape(text)}</text>"
    )
