"""Two bodies that touch, and what stands about them, from the front and from above."""

from markupsafe import Markup

from twin.inspection.hull import hull
from twin.report.data import Contact
from twin.report.drawing import Drawing, Plot, standalone

WIDTH = 180.0
"""[mm]"""
GUTTER = 11.0
"""left of each view, for its figures [mm]"""
SIDE = 76.0
"""of each view [mm]"""
TOP = 6.0
ABOUT = 190.0
"""[mm] of the machine to each side of the contact"""
VIEWS = (("Along the work axis, from its free end", 0, 1), ("From above", 2, 0))
NAMES = "XYZ"
STYLE = """<style>text{font:2.4px sans-serif;fill:#1f2933}path{fill:none}
.axis{stroke:#52606d;stroke-width:.18}
.body{fill:#eef3f8;stroke:#52606d;stroke-width:.13}.place{fill:none;stroke:#1f2933;stroke-width:.35}
.touching{fill:#a92a22;fill-opacity:.25;stroke:#a92a22;stroke-width:.3}
.touched{fill:#1f5fa8;fill-opacity:.25;stroke:#1f5fa8;stroke-width:.3}</style>"""
"""of the picture as a file of its own"""


def contact_chart(contact: Contact) -> Markup:
    """SVG of the collision; the two bodies stand out, the place is marked."""
    drawing = Drawing("contact", WIDTH, TOP + SIDE + 9.0)
    for number, (title, across, up) in enumerate(VIEWS):
        left = GUTTER + number * WIDTH / 2
        drawing.text(left, 3.6, title, "title")
        x, y = float(contact.point[across]), float(contact.point[up])
        plot = Plot(
            drawing,
            left=left,
            top=TOP,
            width=SIDE,
            height=SIDE,
            x=(x - ABOUT, x + ABOUT),
            y=(y - ABOUT, y + ABOUT),
        )
        window = drawing.window(f"view{number}", left, TOP, SIDE, SIDE)
        ordered = sorted(contact.shapes, key=lambda shape: shape[0] in contact.bodies)
        for body, points in ordered:
            kind = (
                ("touching" if body == contact.bodies[0] else "touched") if body in contact.bodies else "body"
            )
            seen = points[:, [across, up]]
            outline = seen[hull(seen)]
            plot.curve(outline[:, 0], outline[:, 1], kind, closed=True, window=window)
        drawing.disc(float(plot.across(x)), float(plot.down(y)), 1.6, "place")
        plot.x_axis(f"{NAMES[across]} [mm]", most=6)
        plot.y_axis(f"{NAMES[up]} [mm]", most=6, room=GUTTER - 2.2)
    return drawing.svg(f"Where {contact.bodies[0]} touches {contact.bodies[1]}, in two views")


def contact_file(contact: Contact) -> str:
    """The same as a file of its own."""
    return standalone(contact_chart(contact), STYLE)
