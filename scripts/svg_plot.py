"""Small plots as SVG files, without a plotting library: lines over logarithmic axes, and bars of shares."""
import math

COLOURS = ["#1b6ca8", "#6bb3e0", "#c0392b", "#e59866", "#7d3c98", "#27806d", "#7f8c8d", "#b7950b", "#34495e", "#a04000"]
LEFT, TOP, WIDTH, HEIGHT, LEGEND = 70, 40, 460, 300, 190


def text(x, y, words, anchor="start", turn=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{turn}>{words}</text>'


def write(path, height, parts):
    head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + LEGEND}" height="{height}" '
            'font-family="sans-serif" font-size="12">')
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([head, '<rect width="100%" height="100%" fill="white"/>', *parts, "</svg>"]) + "\n")


def ticks(low, high):
    """1, 2 and 5 times the powers of ten between the ends."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [m * 10.0**p for p in powers for m in (1, 2, 5) if low <= m * 10.0**p <= high]


def lines(path, title, x_name, y_name, series):
    """series: name -> points (x, y), all above 0."""
    points = [p for line in series.values() for p in line]
    ends = [(min(v) / 1.3, max(v) * 1.3) for v in zip(*points)]

    def place(p):
        share = [math.log(v / low) / math.log(high / low) for v, (low, high) in zip(p, ends)]
        return LEFT + WIDTH * share[0], TOP + HEIGHT * (1 - share[1])

    parts = [text(LEFT, 22, title), f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>']
    for v in ticks(*ends[0]):
        x = place((v, ends[1][0]))[0]
        parts += [f'<path d="M{x:.1f} {TOP}V{TOP + HEIGHT}" stroke="#ddd"/>', text(x, TOP + HEIGHT + 16, f"{v:g}", "middle")]
    for v in ticks(*ends[1]):
        y = place((ends[0][0], v))[1]
        parts += [f'<path d="M{LEFT} {y:.1f}H{LEFT + WIDTH}" stroke="#ddd"/>', text(LEFT - 6, y + 4, f"{v:g}", "end")]
    parts += [text(LEFT + WIDTH / 2, TOP + HEIGHT + 34, x_name, "middle"),
              text(18, TOP + HEIGHT / 2, y_name, "middle", f' transform="rotate(-90 18 {TOP + HEIGHT / 2})"')]
    for k, (name, line) in enumerate(series.items()):
        at, colour = [place(p) for p in sorted(line)], COLOURS[k % len(COLOURS)]
        parts.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in at)}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>' for x, y in at]
        y = TOP + 14 + 20 * k
        parts += [f'<circle cx="{LEFT + WIDTH + 16}" cy="{y - 4}" r="5" fill="{colour}"/>', text(LEFT + WIDTH + 28, y, name)]
    write(path, TOP + HEIGHT + 50, parts)


def shares(path, title, bars):
    """bars: name -> {part: amount}; all bars are of one length, parts in the order of the first bar that has them."""
    names = list(dict.fromkeys(part for bar in bars.values() for part in bar))
    parts = [text(LEFT, 22, title)]
    for row, (name, bar) in enumerate(bars.items()):
        x, y = float(LEFT), TOP + 34 * row
        parts.append(text(LEFT - 6, y + 17, name, "end"))
        for part, amount in bar.items():
            width = WIDTH * amount / sum(bar.values())
            parts.append(f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="24" fill="{COLOURS[names.index(part) % len(COLOURS)]}"/>')
            x += width
    for k, name in enumerate(names):
        y = TOP + 14 + 20 * k
        parts += [f'<rect x="{LEFT + WIDTH + 10}" y="{y - 10}" width="12" height="12" fill="{COLOURS[k % len(COLOURS)]}"/>',
                  text(LEFT + WIDTH + 28, y, name)]
    write(path, TOP + max(34 * len(bars), 20 * len(names)) + 20, parts)
