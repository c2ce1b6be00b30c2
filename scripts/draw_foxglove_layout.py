#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Draws what a layout of Foxglove shows of recorded messages, without Foxglove.

usage: draw_foxglove_layout.py LAYOUT.json MESSAGES.bag PICTURE.png [X Y DISTANCE]

Panels are where the layout puts them. A 3D panel that looks down (without
perspective) has the map, markers, poses, points and frames, in the layout's
colours; the others have their texts. It is a drawing, not a screenshot: buttons,
fonts and shades of the app are not imitated. MESSAGES.bag is a bag of ROS 1 with
the layout's topics, /tf and /tf_static, as `ROS_TEST_RECORD=MESSAGES.bag
scripts/test_ros.sh` records it; the last message of each topic is drawn. With X, Y and
DISTANCE [m], the camera is moved to there, as an operator would.

Needs Debian's python3-matplotlib, python3-numpy, python3-rosbag and python3-tf2-msgs.
"""

import io
import json
import math
import sys
import textwrap

WIDTH, HEIGHT, DPI = 1280, 800, 100
GAP, TITLE_HEIGHT, MARGIN, LINE_HEIGHT = 3, 26, 10, 17  # [pixels]
BACKGROUND, PANEL, TITLE, FIELD = "#101014", "#1c1c22", "#28282f", "#303038"
TEXT, DIM = "#e8e8ec", "#9c9ca6"
LEVELS = (("OK", "#4cc76a"), ("WARN", "#f0a030"), ("ERROR", "#f05050"), ("STALE", DIM))
NUM_COLORS = 256
AXIS_LENGTH = 1.  # [m]
LINE_STRIP, LINE_LIST = 4, 5  # of visualization_msgs/Marker
DELETE, DELETE_ALL = 2, 3


def arrange(node, box):
    """(panel, box) of each panel below a node of the layout; a box is x, y from the
    top, width, height."""
    if isinstance(node, str):
        return [(node, box)]
    x, y, width, height = box
    part = node.get("splitPercentage", 50) / 100.
    if node["direction"] == "row":
        boxes = ((x, y, part * width, height), (x + part * width, y, (1. - part) * width, height))
    else:
        boxes = ((x, y, width, part * height), (x, y + part * height, width, (1. - part) * height))
    return arrange(node["first"], boxes[0]) + arrange(node["second"], boxes[1])


def type_of(panel):
    """Of a panel's name in the layout."""
    return panel.split("!")[0]


def topics_of(layout):
    """All that panels of the layout show."""
    topics = set()
    for config in layout["configById"].values():
        topics.update(config.get("topics", {}))
        topics.update([config["topicToRender"]] if "topicToRender" in config else [])
    return topics


def read_messages(path, topics):
    """The last message by topic; markers and transforms, of which there are many, by
    what names them."""
    import rosbag
    messages, markers, transforms = {}, {}, {}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages([*topics, "/tf", "/tf_static"]):
            messages[topic] = message
            for marker in getattr(message, "markers", ()):
                if marker.action == DELETE_ALL:
                    markers[topic] = {}
                elif marker.action == DELETE:
                    markers.setdefault(topic, {}).pop((marker.ns, marker.id), None)
                else:
                    markers.setdefault(topic, {})[marker.ns, marker.id] = marker
            for transform in getattr(message, "transforms", ()):
                transforms[transform.child_frame_id] = transform
    return messages, markers, transforms


def planar(position, rotation):
    """(x, y, yaw)"""
    return position.x, position.y, 2. * math.atan2(rotation.z, rotation.w)


def compose(a, b):
    """The pose b, seen from a, in the frame of a."""
    cosine, sine = math.cos(a[2]), math.sin(a[2])
    return a[0] + cosine * b[0] - sine * b[1], a[1] + sine * b[0] + cosine * b[1], a[2] + b[2]


def pose_in(frame, child, transforms):
    """Of a frame in another one above it; none if it is not below that."""
    pose = (0., 0., 0.)
    while child != frame:
        if child not in transforms:
            return None
        up = transforms[child]
        pose = compose(planar(up.transform.translation, up.transform.rotation), pose)
        child = up.header.frame_id
    return pose


def draw_grid(axes, message, config):
    """A nav_msgs/OccupancyGrid in the colours of a custom colour mode."""
    import numpy
    from matplotlib import colors
    info = message.info
    cells = numpy.array(message.data).reshape(info.height, info.width)
    low, high, unknown = (numpy.array(colors.to_rgba(config[key]))
                          for key in ("minColor", "maxColor", "unknownColor"))
    image = low + (high - low) * (cells[..., None].clip(0, 100) / 100.)
    image[cells < 0] = unknown
    x, y = info.origin.position.x, info.origin.position.y
    axes.imshow(image, origin="lower", interpolation="antialiased", zorder=1,
                extent=(x, x + info.width * info.resolution, y, y + info.height * info.resolution))


def draw_lines(axes, markers, pixels_per_meter):
    from matplotlib.collections import LineCollection
    for marker in markers.values():
        pose = planar(marker.pose.position, marker.pose.orientation)
        points = [compose(pose, (point.x, point.y, 0.))[:2] for point in marker.points]
        if marker.type == LINE_LIST:
            lines = list(zip(points[::2], points[1::2]))
        elif marker.type == LINE_STRIP:
            lines = [points]
        else:
            continue
        color = marker.color
        axes.add_collection(LineCollection(
            lines, colors=[(color.r, color.g, color.b, color.a)], zorder=3,
            linewidths=max(marker.scale.x * pixels_per_meter, 1.) * 72. / DPI))


def draw_points(axes, message, frame, transforms, config):
    """A sensor_msgs/PointCloud2 in one colour."""
    import struct
    pose = pose_in(frame, message.header.frame_id, transforms)
    if pose is None:
        return
    offsets = {field.name: field.offset for field in message.fields}
    points = []
    for begin in range(0, message.width * message.height * message.point_step, message.point_step):
        x, y = (struct.unpack_from("<f", message.data, begin + offsets[axis])[0] for axis in "xy")
        points.append(compose(pose, (x, y, 0.))[:2])
    axes.scatter(*zip(*points), s=(config["pointSize"] * 72. / DPI) ** 2, linewidths=0,
                 color=config["flatColor"], zorder=4)


def draw_pose(axes, message, config):
    """A geometry_msgs/PoseWithCovarianceStamped as an arrow in an ellipse."""
    from matplotlib.patches import Ellipse
    x, y, yaw = planar(message.pose.pose.position, message.pose.pose.orientation)
    length, width, _ = config["arrowScale"]
    if config.get("showCovariance"):
        covariance = message.pose.covariance
        axes.add_patch(Ellipse((x, y), math.sqrt(covariance[0]), math.sqrt(covariance[7]),
                               color=config["covarianceColor"], zorder=5, linewidth=0))
    axes.arrow(x, y, length * math.cos(yaw), length * math.sin(yaw), width=width,
               head_width=2. * width, length_includes_head=True, color=config["color"], zorder=6,
               linewidth=0)


def draw_frames(axes, frame, transforms):
    """All below a frame, and the frame itself; of those in one place, one has a name."""
    named = []
    for child in (frame, *sorted(transforms)):
        pose = pose_in(frame, child, transforms)
        if pose is None:
            continue
        for x, y, color in ((AXIS_LENGTH, 0., "#ff4040"), (0., AXIS_LENGTH, "#40e040")):
            end = compose(pose, (x, y, 0.))
            axes.plot((pose[0], end[0]), (pose[1], end[1]), color=color, linewidth=2., zorder=7)
        if all(math.dist(pose[:2], other) > AXIS_LENGTH / 2. for other in named):
            named.append(pose[:2])
            axes.annotate(child, pose[:2], (0, -12), textcoords="offset points", color=TEXT,
                          fontsize=8, ha="center", zorder=8, annotation_clip=True,
                          bbox={"boxstyle": "round", "facecolor": "#00000090", "linewidth": 0})


def draw_scene(axes, box, config, recorded):
    """Of a 3D panel: the camera sees `distance` metres from top to bottom."""
    messages, markers, transforms = recorded
    camera, frame = config["cameraState"], config["followTf"]
    if camera["perspective"] or camera["thetaOffset"] != 0:
        raise ValueError("only a camera without perspective and rotation can be drawn")
    pixels_per_meter = box[3] / camera["distance"]
    middle = camera["targetOffset"]
    for limit, center, size in ((axes.set_xlim, middle[0], box[2]),
                                (axes.set_ylim, middle[1], box[3])):
        limit(center - size / 2. / pixels_per_meter, center + size / 2. / pixels_per_meter)
    axes.set_facecolor(config["scene"]["backgroundColor"])
    axes.set_autoscale_on(False)
    for topic, settings in config["topics"].items():
        message = messages.get(topic)
        if not settings["visible"] or message is None:
            continue
        kind = type(message).__name__
        if kind.endswith("OccupancyGrid"):
            draw_grid(axes, message, settings)
        elif kind.endswith("MarkerArray"):
            draw_lines(axes, markers.get(topic, {}), pixels_per_meter)
        elif kind.endswith("PointCloud2"):
            draw_points(axes, message, frame, transforms, settings)
        elif kind.endswith("PoseWithCovarianceStamped"):
            draw_pose(axes, message, settings)
    draw_frames(axes, frame, transforms)


class Writer:
    """Lines of text, from the top of a panel."""

    def __init__(self, axes, box):
        self.axes, self.box, self.y = axes, box, MARGIN
        axes.set_xlim(0, box[2])
        axes.set_ylim(box[3], 0)

    def longest(self, width, size=9):
        """How many characters fit into a width."""
        return int(width / (0.62 * size * DPI / 72.))

    def write(self, text, x=0, color=TEXT, size=9, **options):
        """Does not go on to the next line; cuts what is wider."""
        longest = self.longest(self.box[2] - x - 2 * MARGIN, size)
        text = text if len(text) <= longest else text[:longest - 1] + "…"
        self.axes.text(MARGIN + x, self.y + LINE_HEIGHT / 2., text, color=color, fontsize=size,
                       va="center", clip_on=True, **options)

    def fill(self, color, height=LINE_HEIGHT, x=0, width=None):
        from matplotlib.patches import Rectangle
        self.axes.add_patch(Rectangle((MARGIN / 2. + x, self.y),
                                      width or self.box[2] - MARGIN - x, height, color=color,
                                      linewidth=0))

    def skip(self, height=LINE_HEIGHT):
        self.y += height


def statuses_of(config, recorded):
    message = recorded[0].get(config["topicToRender"])
    return message.status if message else []


def draw_status(axes, box, config, recorded):
    """Of a panel with the details of a diagnostic status."""
    writer = Writer(axes, box)
    for status in statuses_of(config, recorded):
        if status.hardware_id != config["selectedHardwareId"]:
            continue
        level, color = LEVELS[status.level]
        writer.write(f"{status.hardware_id}: {status.name}", color=color, weight="bold")
        writer.skip()
        writer.write(status.message, color=color)
        writer.skip(LINE_HEIGHT + 4)
        for k, pair in enumerate(status.values):
            lines = textwrap.wrap(pair.value, writer.longest(box[2] / 2. - 2 * MARGIN)) or [""]
            writer.fill(FIELD if k % 2 else PANEL, height=len(lines) * LINE_HEIGHT)
            writer.write(pair.key)
            for line in lines:
                writer.write(line, x=box[2] / 2.)
                writer.skip()


def draw_summary(axes, box, config, recorded):
    """Of a panel with a line for each diagnostic status."""
    writer = Writer(axes, box)
    writer.fill(FIELD)
    writer.write(f"{LEVELS[config['minLevel']][0]} ▾   {config['hardwareIdFilter']}", color=DIM)
    writer.skip(LINE_HEIGHT + 6)
    for status in statuses_of(config, recorded):
        if (config["hardwareIdFilter"] in f"{status.hardware_id}: {status.name}"
                and status.level >= config["minLevel"]):
            writer.write(f"{status.hardware_id}: {status.name}")
            writer.skip()
            writer.write(status.message, color=LEVELS[status.level][1])
            writer.skip()


def draw_service(axes, box, config, _):
    """Of a panel that calls a service: what it sends and gets, and its button."""
    writer = Writer(axes, box)
    across = config["layout"] == "horizontal"
    button = box[3] - 36
    width = (box[2] - MARGIN) / (2. if across else 1.) - MARGIN / 2.
    height = (button - MARGIN) / (1. if across else 2.) - LINE_HEIGHT - 6
    for k, (name, content) in enumerate((("Request", config["requestPayload"]), ("Response", ""))):
        x = k * (width + MARGIN / 2.) if across else 0
        writer.y = MARGIN if across else MARGIN + k * (height + LINE_HEIGHT + 6)
        writer.write(name, x=x, color=DIM, size=8)
        writer.skip()
        writer.fill(FIELD, height=height, x=x, width=width)
        for line in content.split("\n")[:int(height / 15.)]:
            writer.write(line, x=x, family="monospace", size=8)
            writer.skip(15)
    writer.y = button
    writer.fill("#4a6de5", height=26, x=(box[2] - 120 - MARGIN) / 2., width=120)
    writer.skip(5)
    writer.write(config["buttonText"], x=box[2] / 2. - MARGIN, ha="center", weight="bold")


PANELS = {
    "3D": ("3D", draw_scene),
    "DiagnosticStatusPanel": ("Diagnostics – Detail (ROS)", draw_status),
    "DiagnosticSummary": ("Diagnostics – Summary (ROS)", draw_summary),
    "CallService": ("Service Call", draw_service),
}


def add_axes(figure, box):
    """Axes in a box of pixels."""
    x, y, width, height = box
    axes = figure.add_axes((x / WIDTH, 1. - (y + height) / HEIGHT, width / WIDTH, height / HEIGHT))
    axes.set_facecolor(PANEL)
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)
    return axes


def draw(layout, recorded, output):
    import matplotlib
    matplotlib.use("Agg")
    from PIL import Image
    from matplotlib import pyplot
    figure = pyplot.figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI, facecolor=BACKGROUND)
    for panel, (x, y, width, height) in arrange(layout["layout"], (0, 0, WIDTH, HEIGHT)):
        x, y, width, height = x + GAP, y + GAP, width - 2 * GAP, height - 2 * GAP
        name, draw_panel = PANELS[type_of(panel)]
        config = layout["configById"][panel]
        title = add_axes(figure, (x, y, width, TITLE_HEIGHT))
        title.set_facecolor(TITLE)
        title.text(MARGIN / width, 0.5, " ".join([name, config.get("serviceName", "")]),
                   color=TEXT, fontsize=9, va="center", transform=title.transAxes)
        box = (x, y + TITLE_HEIGHT, width, height - TITLE_HEIGHT)
        draw_panel(add_axes(figure, box), box, config, recorded)
    picture = io.BytesIO()
    figure.savefig(picture, dpi=DPI, facecolor=BACKGROUND)
    # Few colours make a small file; rare ones are kept.
    Image.open(picture).convert("RGB").quantize(
        NUM_COLORS, Image.MAXCOVERAGE).save(output, optimize=True)


def main():
    if len(sys.argv) not in (4, 7):
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        layout = json.load(file)
    if len(sys.argv) == 7:
        x, y, distance = map(float, sys.argv[4:])
        for panel, config in layout["configById"].items():
            if type_of(panel) == "3D":
                config["cameraState"].update(targetOffset=[x, y, 0.], distance=distance)
    draw(layout, read_messages(sys.argv[2], topics_of(layout)), sys.argv[3])


if __name__ == "__main__":
    main()
