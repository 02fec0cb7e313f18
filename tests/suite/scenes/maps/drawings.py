"""SVG drawings with all that a reader of them must understand."""

HEAD = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'viewBox="10 20 400 300" {}>{}</svg>'
)


def svg(body: str, attributes: str = 'width="400" height="300"') -> str:
    return HEAD.format(attributes, body)


EVERYTHING = {
    "a path of all commands": svg(
        '<path d="M60 60 h60 v40 l-20 20 H80 V90 z m150 0 c40 -60 80 60 120 0 s20 60 -20 80 '
        "q-40 20 -60 0 t-40 0 z M80 200 a60 30 30 1 0 80 20 A 30 30 0 0 1 100 280 Z M250 200 "
        'L300 200 300 250"/>'
    ),
    "fill rules": svg(
        '<path fill-rule="evenodd" d="M100 40 l40 120 -100 -75 h120 l-100 75z"/>'
        '<path d="M250 40 l40 120 -100 -75 h120 l-100 75z"/>'
        '<path d="M40 200 h120 v100 h-120z M70 220 h60 v60 h-60z"/>'
        '<path d="M240 200 h120 v100 h-120z M270 220 v60 h60 v-60z"/>'
    ),
    "shapes": svg(
        '<rect x="30" y="40" width="20%" height="60"/><rect x="150" y="40" width="80" height="60" '
        'rx="20" ry="10"/><circle cx="300" cy="80" r="40"/><ellipse cx="90" cy="180" rx="60" '
        'ry="30"/><polygon points="200,150 260,150 230,210"/><polyline points="300,150 360,150 '
        '330,210"/><line x1="40" y1="260" x2="200" y2="290" stroke="black" stroke-width="12"/>'
    ),
    "transforms in groups": svg(
        '<g transform="translate(100 60) rotate(30)"><g transform="scale(2 0.5) skewX(20)">'
        '<circle cx="20" cy="40" r="30"/><rect x="60" y="-20" width="30" height="90" rx="10"/></g>'
        '<path transform="matrix(0 1 -1 0 120 120)" d="M0 0 h60 a30 15 0 0 1 -60 30z"/></g>'
        '<g transform="rotate(45 300 220)"><rect x="260" y="200" width="80" height="40"/></g>'
    ),
    "clones and definitions": svg(
        '<defs><circle id="dot" r="20"/></defs><symbol id="s"><rect width="50" height="30"/>'
        '</symbol><use xlink:href="#dot" x="60" y="80"/><use href="#dot" x="60" y="80" '
        'transform="translate(80 0) scale(1.5)"/><g id="pair"><rect x="250" y="60" width="30" '
        'height="30"/><rect x="290" y="60" width="30" height="60"/></g><use href="#pair" '
        'transform="rotate(20 300 100) translate(-40 100)"/><use href="#s" x="50" y="250"/>'
        '<mask id="m"><rect x="150" y="200" width="90" height="90"/></mask>'
    ),
    "strokes": svg(
        '<g fill="none" stroke="#333" stroke-width="16"><path d="M40 60 l60 60 60 -60"/>'
        '<path stroke-linejoin="round" stroke-linecap="round" d="M200 60 l60 60 60 -60"/>'
        '<path stroke-linejoin="bevel" stroke-linecap="square" d="M40 180 l60 60 60 -60"/>'
        '<path d="M220 170 h80 v60 h-80z"/></g><circle cx="360" cy="240" r="30" fill="#ccc" '
        'stroke="red" stroke-width="10"/><g transform="scale(3 1)"><path fill="none" '
        'stroke="black" stroke-width="6" d="M20 270 h40 v40 h20"/></g>'
    ),
    "white hides, and what is not painted is not there": svg(
        '<rect x="10" y="20" width="400" height="300" fill="white"/>'
        '<rect x="40" y="50" width="200" height="150"/>'
        '<circle cx="140" cy="125" r="50" fill="#fff"/><rect x="120" y="110" '
        'width="40" height="30" fill="blue"/><rect x="260" y="50" width="60" height="60" '
        'fill="none"/><g style="display:none"><rect x="330" y="50" width="60" height="60"/></g>'
        '<rect x="260" y="130" width="60" height="60" visibility="hidden"/><g fill="none">'
        '<rect x="330" y="130" width="60" height="60" style="fill:#888"/></g><rect x="60" y="230" '
        'width="300" height="60" fill="none" stroke="black" stroke-width="20"/><rect x="60" '
        'y="230" width="300" height="60" fill="none" stroke="white" stroke-width="8"/>'
    ),
    "styles": svg(
        "<style>.wall {fill: none; stroke: #000; stroke-width: 14} #free {fill: white} rect.room "
        '{fill: rgb(90, 90, 90)}</style><path class="wall" d="M40 60 h300 v80"/><rect class="room" '
        'x="60" y="120" width="150" height="150"/><rect id="free" x="100" y="160" width="50" '
        'height="50"/>'
    ),
    "another shape of the page, and what sticks out of it": svg(
        '<rect x="-50" y="0" width="120" height="100"/><circle cx="400" cy="300" r="80"/>'
    ),
}  # fmt: skip
