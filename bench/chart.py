"""Plain SVG charts: error against cost as lines, and bars. Standard library only."""
import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 920, 540, 80, 260, 50, 60
COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f4f24", "#8a8a00", "#6a3d9a", "#555555",
           "#b15928", "#f032e6", "#a6761d", "#386cb0")
OURS = "#000000"
DASHES = ("", "12 5", "7 4", "3 3", "1 4")  # ours, where there are several


def superscript(exponent):
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def decades(values):
    low, high = math.floor(math.log10(min(values)) + 1e-9), math.ceil(math.log10(max(values)) - 1e-9)
    return low, max(high, low + 1)


def dashed(dashes):
    return f'stroke-dasharray="{dashes}"' if dashes else ""


class Axes:
    """Log-log axes of a picture."""

    def __init__(self, title, x_label, y_label, xs, ys):
        self.x, self.y = decades(xs), decades(ys)
        self.parts = [f'<text x="{LEFT}" y="28" font-size="17" font-weight="bold">{escape(title)}</text>']
        for exponent in range(self.x[0], self.x[1] + 1):
            at = self.across(10.0 ** exponent)
            self.line(at, TOP, at, HEIGHT - BOTTOM, "#dddddd", 1)
            self.parts.append(f'<text x="{at:.1f}" y="{HEIGHT - BOTTOM + 20}" text-anchor="middle">{superscript(exponent)}</text>')
        for exponent in range(self.y[0], self.y[1] + 1):
            at = self.up(10.0 ** exponent)
            self.line(LEFT, at, WIDTH - RIGHT, at, "#dddddd", 1)
            self.parts.append(f'<text x="{LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{superscript(exponent)}</text>')
        middle = (LEFT + WIDTH - RIGHT) / 2
        self.parts.append(f'<text x="{middle}" y="{HEIGHT - 15}" text-anchor="middle">{escape(x_label)}</text>')
        self.parts.append(f'<text x="22" y="{HEIGHT / 2}" text-anchor="middle" transform="rotate(-90 22 {HEIGHT / 2})">'
                          f'{escape(y_label)}</text>')

    def across(self, value):
        return LEFT + (math.log10(value) - self.x[0]) / (self.x[1] - self.x[0]) * (WIDTH - RIGHT - LEFT)

    def up(self, value):
        return HEIGHT - BOTTOM - (math.log10(value) - self.y[0]) / (self.y[1] - self.y[0]) * (HEIGHT - BOTTOM - TOP)

    def line(self, x1, y1, x2, y2, colour, width, dashes=""):
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
                          f'stroke-width="{width}" {dashed(dashes)}/>')

    def series(self, index, name, points, colour, width, dashes=""):
        path = " ".join(f"{self.across(x):.1f},{self.up(y):.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}" '
                          f'{dashed(dashes)}/>')
        for x, y in points:
            self.parts.append(f'<circle cx="{self.across(x):.1f}" cy="{self.up(y):.1f}" r="{1.5 + width / 2}" fill="{colour}"/>')
        at = TOP + 12 + 20 * index
        self.line(WIDTH - RIGHT + 10, at, WIDTH - RIGHT + 48, at, colour, width + 0.5, dashes)
        self.parts.append(f'<text x="{WIDTH - RIGHT + 54}" y="{at + 4}">{escape(name)}</text>')


def picture(parts, height=HEIGHT):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
            f'font-family="sans-serif" font-size="13"><rect width="{WIDTH}" height="{height}" fill="white"/>'
            + "\n".join(parts) + "</svg>\n")


def colours_of(names):
    """Ours black, the others from the palette, in order."""
    others = [name for name in names if not name.startswith("limcycle")]
    return {name: COLOURS[others.index(name) % len(COLOURS)] if name in others else OURS for name in names}


def lines(title, x_label, y_label, series):
    """`series`: name -> [(x, y)], positive numbers."""
    series = {name: points for name, points in series.items() if points}
    axes = Axes(title, x_label, y_label, [x for points in series.values() for x, _ in points],
                [y for points in series.values() for _, y in points])
    colours = colours_of(series)
    ours = sorted(name for name in series if name.startswith("limcycle"))  # the plain name comes first
    for index, (name, points) in enumerate(series.items()):
        dashes = DASHES[ours.index(name) % len(DASHES)] if name in ours else ""
        axes.series(index, name, points, colours[name], 3 if name in ours else 1.5, dashes)
    return picture(axes.parts)


def bars(title, x_label, values):
    """`values`: [(name, value, remark)], value > 0, on a log scale from the decade below the least."""
    low, high = decades([value for _, value, _ in values])
    low -= 1 if math.log10(min(value for _, value, _ in values)) - low < 0.3 else 0
    left, bottom = 330, TOP + 34 * len(values) + 10
    parts = [f'<text x="20" y="28" font-size="17" font-weight="bold">{escape(title)}</text>']

    def across(value):
        return left + (math.log10(value) - low) / (high - low) * (WIDTH - left - 170)

    for exponent in range(low, high + 1):
        at = across(10.0 ** exponent)
        parts.append(f'<line x1="{at:.1f}" y1="{TOP}" x2="{at:.1f}" y2="{bottom}" stroke="#dddddd"/>')
        parts.append(f'<text x="{at:.1f}" y="{bottom + 18}" text-anchor="middle">{superscript(exponent)}</text>')
    for index, (name, value, remark) in enumerate(values):
        y = TOP + 34 * index + 6
        colour = OURS if name.startswith("limcycle") else COLOURS[1]
        parts.append(f'<text x="{left - 10}" y="{y + 16}" text-anchor="end">{escape(name)}</text>')
        parts.append(f'<rect x="{left}" y="{y}" width="{across(value) - left:.1f}" height="22" fill="{colour}"/>')
        parts.append(f'<text x="{across(value) + 6:.1f}" y="{y + 16}">{escape(remark)}</text>')
    parts.append(f'<text x="{(left + WIDTH - 170) / 2}" y="{bottom + 40}" text-anchor="middle">{escape(x_label)}</text>')
    return picture(parts, bottom + 55)
