"""The pictures and the movie of the main job, rendered by ParaView.

Rocks of 1 m can hardly be seen on a slope of 1 km. So the views from afar show where rocks went, as
tubes, and the movie's rocks there are enlarged, which its caption says; the near views have the real
polyhedra in their real size.
"""
import numpy as np
from paraview.simple import *

from rockfall_ground import add_array, cells, hillshade, make_polydata
from rockfall_view import *

kept = {}  # Functions that the animation calls, by name.

ENLARGED = 8.0  # Size of the movie's rocks seen from afar over their real one.


class Scene:
    """Everything that the pictures show."""

    def __init__(self, ground, simulation, paths, summary):
        self.ground, self.paths, self.summary = ground, paths, summary
        self.rocks = OutputPort(simulation, 0)
        self.trajectories = OutputPort(simulation, 1)
        self.low, self.high = paths.points.min(axis=0), paths.points.max(axis=0)
        pad = np.maximum(0.0, 50.0 - (self.high - self.low)) / 2  # if hardly anything moves
        self.low, self.high = self.low - pad, self.high + pad
        self.starts = paths.points[paths.starts[:-1]]
        self.stops = paths.points[paths.starts[1:] - 1]
        self.top = max(5.0, float(np.ceil(paths.speed.max() / 5.0) * 5.0))
        self.count = len(paths.block)
        west, south = self.low[:2] - 1000.0
        east, north = self.high[:2] + 1000.0
        # Light from the upper left, as maps have it, or right if that slope lies in the shade.
        self.down = (self.stops - self.starts)[:, :2].sum(axis=0)
        self.down /= np.linalg.norm(self.down) or 1.0
        self.light = 315.0 if self.down[0] < 0 else 45.0
        self.bounds = west, east, south, north
        self.slope = produce(ground.patch(*self.bounds, hillshade(self.light)))

    def name_ground(self, view, position, size):
        """What the rocks fall on: the ground decides how far they go."""
        write(view, "Ground: " + self.ground.name, position, size)

    def save_slope(self, path):
        SaveData(path, proxy=self.slope, DataMode="Binary")

    def thinned(self, spacing):
        """Numbers of samples per rock that are some way apart: closer ones, of rocks that hardly
        move, would swell a tube."""
        kept_samples = []
        for rock in range(self.count):
            own = self.paths.of(rock)
            places, taken = self.paths.points[own].tolist(), [0]
            for k, place in enumerate(places):
                last = places[taken[-1]]
                if sum(abs(a - b) for a, b in zip(place, last)) > spacing:
                    taken.append(k)
            if taken[-1] != len(places) - 1:
                taken.append(len(places) - 1)
            kept_samples.append(own.start + np.array(taken))
        return kept_samples

    def tubes(self, radius):
        """The trajectories as tubes with the point array Speed."""
        taken = self.thinned(2 * radius)
        ends = np.cumsum([len(t) for t in taken])
        polydata = make_polydata(self.paths.points[np.concatenate(taken)])
        polydata.SetLines(cells(np.split(np.arange(ends[-1]), ends[:-1])))
        add_array(polydata.GetPointData(), "Speed", self.paths.speed[np.concatenate(taken)])
        return Tube(Input=produce(polydata), Radius=radius, NumberofSides=8)

    def trails(self, spacing):
        """The trajectories as pieces with the point array Speed and the cell array Time, of the piece's
        end."""
        pieces = np.concatenate([np.column_stack([t[:-1], t[1:]]) for t in self.thinned(spacing)])
        polydata = make_polydata(self.paths.points[pieces].reshape(-1, 3) + [0.0, 0.0, 1.0])
        polydata.SetLines(cells(np.arange(2 * len(pieces)).reshape(-1, 2)))
        add_array(polydata.GetPointData(), "Speed", self.paths.speed[pieces].ravel())
        add_array(polydata.GetCellData(), "Time", self.paths.time[pieces[:, 1]])
        return produce(polydata)

    # --- From above

    def map_view(self, centre, width, title, stride=1, size=(1500, 1100)):
        """A map of `width` m of ground, north up, with title, scale bar and north arrow; its legend's
        column is right of it. Returns the view, the ground, and the metres of a pixel."""
        share = (0.80, 0.90)  # of the picture that the map takes, from its lower left corner
        margin = 0.02
        metres = width / (share[0] * size[0])  # per pixel
        height = metres * share[1] * size[1]
        west, south = centre[0] - width / 2, centre[1] - height / 2
        bounds = (west, west + width, south, south + height)
        shade = hillshade(self.light) if stride == 1 else hillshade(smooth=0)
        ground = produce(self.ground.patch(*bounds, shade, stride))

        view = new_view(size)
        show_slope(ground, view)
        focus = [west + (0.5 - margin) * size[0] * metres, south + (0.5 - margin) * size[1] * metres]
        view.CameraParallelProjection = 1
        view.CameraParallelScale = 0.5 * size[1] * metres
        view.CameraFocalPoint = focus + [0.0]
        view.CameraPosition = focus + [20000.0]
        view.CameraViewUp = [0.0, 1.0, 0.0]

        write(view, title, (margin, 0.945), 28, bold=True)
        # Scale bar: four fields, in the legend's column.
        left, up = west + (share[0] + 0.02) * size[0] * metres, south + 0.03 * size[1] * metres
        length = round_length(0.11 * size[0] * metres)
        for first, colour in ((0, INK), (1, [0.8] * 3)):
            x = left + length / 4 * (np.array([[first], [first + 2]]) + [0, 1, 1, 0])
            y = up + 0.01 * size[1] * metres * np.array([[0, 0, 1, 1]] * 2)
            flat(quads(np.stack([x, y, np.full((2, 4), 3000.0)], -1)), view, colour)
        write(view, "0", (margin + share[0] + 0.02, 0.065), 20, centred=True)
        write(view, length_text(length),
              (margin + share[0] + 0.02 + length / metres / size[0], 0.065), 20, centred=True)
        # North arrow.
        across, tall = 0.018 * size[0] * metres, 0.05 * size[0] * metres
        x, y = left + 2 * across, south + 0.12 * size[1] * metres
        arrow = np.array([[x, y + tall, 3000], [x - across, y, 3000], [x, y + tall / 4, 3000],
                          [x + across, y, 3000]])
        flat(quads(arrow[None]), view, INK)
        write(view, "N", seen_at(view, (x, y + 1.1 * tall, 0)), 26, bold=True, centred=True)
        return view, ground, metres

    def overview(self, path):
        ground = self.ground
        centre = [ground.west + 0.5 * ground.columns * ground.cell,
                  ground.south + 0.5 * ground.rows * ground.cell]
        view, _, _ = self.map_view(
            centre, 1.02 * ground.cell * max(ground.columns, 1.2122 * ground.rows),
            "The Jacksboro fault, Tennessee: DEM and place of the rockfall", stride=8)
        west, east = self.low[0] - 500, self.high[0] + 500
        south, north = self.low[1] - 500, self.high[1] + 500
        corners = np.array([[x, y, 2500.0] for x, y in (
            (west, south), (east, south), (east, north), (west, north))])
        frame = make_polydata(corners)
        frame.SetLines(cells(np.array([[0, 1], [1, 2], [2, 3], [3, 0]])))
        flat(produce(frame), view, [0.85, 0.1, 0.1], LineWidth=4)
        place = seen_at(view, (0.5 * (west + east), north, 0))
        write(view, "rockfall", (place[0], place[1] + 0.008), 24, [0.85, 0.1, 0.1], True, True)
        self.save(view, path)

    def map(self, path):
        span = self.high[:2] - self.low[:2]
        view, ground, metres = self.map_view(
            0.5 * (self.low + self.high)[:2], 1.25 * max(span[0], span[1] / 0.82),
            f"{self.count} rocks fall from an escarpment at the Jacksboro fault")
        self.contours(view, ground, 10.0)
        show_speed(self.tubes(1.5 * metres), view, self.top)
        speed_bar(view, (0.862, 0.5), 0.4)
        lift = np.array([0.0, 0.0, 60.0])  # over all else
        dot = 4.0 * metres
        flat(points_source(self.stops + lift, dot), view, INK)
        flat(points_source(self.starts + 2 * lift, 0.7 * dot), view, RELEASED)
        write(view, "blue: released\nblack: stopped\ncontours: 10 m", (0.845, 0.33), 20)
        self.name_ground(view, (0.02, 0.915), 20)
        self.save(view, path)

    def contours(self, view, ground, step):
        low, high = ground.PointData["Elevation"].GetRange()
        levels = np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step
        for every, width in ((levels, 1.0), (levels[levels % (5 * step) == 0], 2.5)):
            lines = Contour(Input=ground, ContourBy=["POINTS", "Elevation"], Isosurfaces=every.tolist())
            flat(lines, view, [0.42, 0.38, 0.28], LineWidth=width, by=[0, 0, 0.5])

    # --- From the side

    def look_from_below(self, view, ends, raised=25.0, turned=25.0):
        """Puts the camera in front of the run-out, looking uphill, as near as leaves every rock's start
        and these ends in the picture, below the title."""
        points = np.concatenate([self.starts, ends])
        focus, away = points.mean(axis=0), np.linalg.norm(np.ptp(points, axis=0))
        angle, tilt = np.arctan2(self.down[1], self.down[0]) + np.radians(turned), np.radians(raised)
        way = np.array([np.cos(angle) * np.cos(tilt), np.sin(angle) * np.cos(tilt), np.sin(tilt)])
        right = np.array([-np.sin(angle), np.cos(angle), 0.0])
        up = np.cross(way, right)
        view.CameraViewUp, view.CameraViewAngle = [0.0, 0.0, 1.0], 30.0
        middle, room = np.array([0.48, 0.44]), np.array([0.8, 0.58])  # of the picture
        for _ in range(8):
            view.CameraFocalPoint, view.CameraPosition = focus.tolist(), (focus + away * way).tolist()
            seen = np.array([seen_at(view, p) for p in points])
            height = 2 * away * np.tan(np.radians(15.0))  # of the picture at the focus, m
            shift = 0.5 * (seen.min(axis=0) + seen.max(axis=0)) - middle
            shift[0] *= view.ViewSize[0] / view.ViewSize[1]
            focus = focus + height * (shift[0] * right + shift[1] * up)
            away *= np.clip((np.ptp(seen, axis=0) / room).max(), 0.7, 1.5)

    def oblique(self, path, size=(1600, 1000)):
        view = new_view(size, (0.86, 0.91, 0.97))
        show_slope(self.slope, view)
        self.contours(view, self.slope, 10.0)
        span = np.linalg.norm((self.high - self.low)[:2])
        show_speed(self.tubes(0.0016 * span), view, self.top)
        self.look_from_below(view, self.stops)
        plain(points_source(self.stops, 0.004 * span), view, INK)
        plain(points_source(self.starts, 0.004 * span), view, RELEASED)
        self.ground_scale(view, 0.64)
        speed_bar(view, (0.9, 0.55), 0.36)
        write(view, f"{self.count} rocks fall from an escarpment at the Jacksboro fault, Tennessee",
              (0.02, 0.945), 28, bold=True)
        write(view, "Tubes: trajectories. Blue: released. Black: stopped. Contours: 10 m.",
              (0.02, 0.905), 20)
        self.name_ground(view, (0.02, 0.875), 20)
        self.save(view, path)

    def ground_scale(self, view, u):
        """A scale bar and a north arrow on the ground, from a share of the picture's width on."""
        begin = self.ground_at(view, u, 0.09)
        right = self.ground_at(view, u + 0.2, 0.09) - begin
        wide = np.linalg.norm(right)  # a fifth of the picture, m
        right /= wide
        length = round_length(wide)

        def strip(start, end, thick):
            along = np.linspace(start, end, 30)
            side = np.array([start[1] - end[1], end[0] - start[0]])
            side *= 0.5 * thick / np.linalg.norm(side)
            edge = [np.column_stack([line, self.ground.height(*line.T) + 1.5])
                    for line in (along + side, along - side)]
            return np.stack([edge[0][:-1], edge[0][1:], edge[1][1:], edge[1][:-1]], 1)

        fields = [strip(begin + right * length * k / 4, begin + right * length * (k + 1) / 4, 0.065 * wide)
                  for k in range(4)]
        tail = begin + right * (length + 0.25 * wide)
        tip = tail + np.array([0.0, 0.35 * wide])
        arrow = [strip(tail, tip, 0.03 * wide)]
        arrow += [strip(tip, tip + wide * np.array([wing, -0.12]), 0.03 * wide)
                  for wing in (-0.07, 0.07)]
        flat(quads(np.concatenate(fields[::2] + arrow)), view, INK)
        flat(quads(np.concatenate(fields[1::2])), view, [1.0] * 3)
        on_ground = lambda p: (*p, float(self.ground.height(*p)))
        for at, text in ((0.0, "0"), (length, length_text(length))):
            u, v = seen_at(view, on_ground(begin + right * at))
            write(view, text, (u, v - 0.05), 22, bold=True, centred=True)
        u, v = seen_at(view, on_ground(tip + np.array([0.0, 0.07 * wide])))
        write(view, "N", (u, v), 26, bold=True, centred=True)

    def ground_at(self, view, u, v):
        """Easting and northing of the ground that is seen at a share of the picture."""
        back = np.linalg.inv(projection(view))
        near, far = (back @ [2 * u - 1, 2 * v - 1, depth, 1] for depth in (-1, 1))
        near, far = near[:3] / near[3], far[:3] / far[3]
        way = far - near
        # The renderer's clipping planes are not known yet; 4 km before the camera are enough.
        points = near + np.linspace(0.0, 4000.0, 8000)[:, None] * way / np.linalg.norm(way)
        below = points[:, 2] < self.ground.height(points[:, 0], points[:, 1])
        return points[np.argmax(below), :2]

    # --- Near

    def near_slope(self, view, centre, reach=120.0):
        """The CFEs around a place, with their edges."""
        grey = hillshade(self.light, smooth=1, low=(196, 204, 160), high=(214, 218, 180))
        patch = produce(self.ground.patch(centre[0] - reach, centre[0] + reach, centre[1] - reach,
                                          centre[1] + reach, grey))
        display = show_slope(patch, view)
        display.Representation = "Surface With Edges"
        display.EdgeColor, display.LineWidth = [0.35, 0.38, 0.26], 1.5

    def show_rocks(self, view, name):
        plain(self.rocks, view, SANDSTONE, Representation="Surface With Edges",
              EdgeColor=[0.25, 0.13, 0.05],
              LineWidth=1.5, Ambient=0.3, Diffuse=0.8, Interpolation="Flat")
        shadow = python_filter(self.rocks, name, lambda data: cast_shadows(data, self.ground))
        flat(shadow, view, [0.3, 0.32, 0.22])

    def close_up(self, path, size=(1600, 1000)):
        """Rocks at rest: the place where the most different shapes lie together."""
        shapes = np.array(self.summary["Shape"])
        rested = np.array(self.summary["Fate"]) == "rested"
        apart = np.linalg.norm(self.stops[:, None] - self.stops, axis=-1)
        near = (apart < 9.0) & rested
        middle = max(range(self.count), key=lambda k: (
            len(set(shapes[near[k]])), -apart[k][near[k]].sum()))
        shown = np.nonzero(near[middle])[0]
        centre = self.stops[shown].mean(axis=0)
        view = new_view(size, (0.86, 0.91, 0.97))
        # As far as rocks lie, or the distant ones would hang in the air.
        reach = np.abs(self.stops[:, :2] - centre[:2]).max() + 60.0
        self.near_slope(view, centre, reach)
        self.show_rocks(view, "close-up")
        view.ViewTime = float(self.paths.time.max())
        eye = self.standing(centre, 14.0, 3.5, 65.0)
        view.CameraPosition, view.CameraFocalPoint = eye.tolist(), centre.tolist()
        view.CameraViewUp, view.CameraViewAngle = [0.0, 0.0, 1.0], 40.0
        for rock in np.nonzero(rested & (np.linalg.norm(self.stops - eye, axis=1) < 30.0))[0]:
            u, v = seen_at(view, self.stops[rock] + [0.0, 0.0, 0.95])
            if 0.05 < u < 0.95 and 0.0 < v < (0.85 if u < 0.35 else 0.94):  # not in the title
                write(view, shapes[rock], (u, v), 24, bold=True, centred=True)
        write(view, "Rocks at rest, in their real size", (0.02, 0.945), 28, bold=True)
        write(view, "Lines: edges of the contact", (0.02, 0.905), 20)
        write(view, "face elements, 10 m apart", (0.02, 0.875), 20)
        self.name_ground(view, (0.02, 0.845), 20)
        self.save(view, path)

    def standing(self, centre, away, over, turned):
        """Where somebody stands downhill of a place, `over` m above the ground."""
        x, y = centre[:2]
        step = 5.0
        fall = np.array([self.ground.height(x - step, y) - self.ground.height(x + step, y),
                         self.ground.height(x, y - step) - self.ground.height(x, y + step)])
        angle = np.arctan2(fall[1], fall[0]) + np.radians(turned)
        place = centre[:2] + away * np.array([np.cos(angle), np.sin(angle)])
        return np.append(place, max(float(self.ground.height(*place)) + over, centre[2] + over / 2))

    def save(self, view, path):
        SaveScreenshot(path, view, ImageResolution=list(view.ViewSize))
        Delete(view)

    # --- Moving

    def movie(self, path, times, say, size=(1280, 640), share=0.62, rate=12):
        """On the left the whole slope with enlarged rocks, on the right one rock in its real size."""
        layout = CreateLayout("Movie")
        layout.SplitHorizontal(0, share)
        layout.SetSize(*size)
        far = new_view((int(share * size[0]), size[1]), (0.86, 0.91, 0.97))
        near = new_view((size[0] - int(share * size[0]), size[1]), (0.86, 0.91, 0.97))
        for view, place in ((far, 1), (near, 2)):
            AssignViewToLayout(view=view, layout=layout, hint=place)
            view.UseFXAA = 0

        # Every second node is enough from afar, and a frame takes half the time.
        coarse = produce(self.ground.patch(*self.bounds, hillshade(self.light, smooth=2), stride=2))
        show_slope(coarse, far)
        self.contours(far, coarse, 50.0)
        trails = Threshold(Input=self.trails(4.0), Scalars=["CELLS", "Time"], ThresholdMethod="Between",
                           LowerThreshold=0.0, UpperThreshold=0.0)
        show_speed(trails, far, self.top).LineWidth = 2.0
        big = python_filter(self.rocks, "enlarged", lambda data: enlarge(data, ENLARGED))
        plain(big, far, SANDSTONE, Representation="Surface With Edges",
              EdgeColor=[0.25, 0.13, 0.05],
              Ambient=0.3, Diffuse=0.8, Interpolation="Flat")
        self.look_from_below(
            far, np.concatenate([self.paths.places(rock, times[-1:]) for rock in range(self.count)]))
        self.ground_scale(far, 0.45)
        speed_bar(far, (0.87, 0.5), 0.36, 14)
        write(far, f"{self.count} rocks at the Jacksboro fault", (0.02, 0.93), 20, bold=True)
        write(far, f"Rocks are shown {ENLARGED:g} times their size.", (0.02, 0.885), 14)
        self.name_ground(far, (0.02, 0.855), 14)
        clock = write(far, "0.0 s", (0.5, 0.93), 20, bold=True)

        rock = int(np.argmax(self.summary["RunOut"]))
        eyes, targets = self.follow(rock, times)
        self.near_slope(near, 0.5 * (self.starts[rock] + self.stops[rock]),
                        0.5 * np.abs(self.stops[rock] - self.starts[rock])[:2].max() + 150.0)
        self.show_rocks(near, "followed")
        near.CameraViewUp, near.CameraViewAngle = [0.0, 0.0, 1.0], 40.0
        write(near, f"Rock {self.summary['BlockId'][rock]} ({self.summary['Shape'][rock]})",
              (0.03, 0.93), 20, bold=True)
        speed = write(near, "in its real size", (0.03, 0.885), 14)

        animation = GetAnimationScene()
        own = self.paths.of(rock)

        def tick(share):
            now = times[0] + share * (times[-1] - times[0])
            frame = int(np.abs(times - now).argmin())
            trails.UpperThreshold = max(now, 1e-3)
            clock.Text = f"{now:.1f} s"
            at = np.interp(now, self.paths.time[own], self.paths.speed[own])
            speed.Text = f"in its real size, {at:.1f} m/s"
            near.CameraPosition, near.CameraFocalPoint = eyes[frame].tolist(), targets[frame].tolist()
            if frame and frame % max(len(times) // 6, 1) == 0:
                say(f"  frame {frame} of {len(times)}")

        kept["tick"] = tick
        cue = PythonAnimationCue()
        cue.Script = ("import rockfall_pictures\n"
                      "def start_cue(self): pass\n"
                      "def tick(self): rockfall_pictures.kept['tick'](self.GetAnimationTime())\n"
                      "def end_cue(self): pass\n")
        animation.Cues.append(cue)
        animation.PlayMode = "Sequence"
        animation.StartTime, animation.EndTime = float(times[0]), float(times[-1])
        animation.NumberOfFrames = len(times)
        tick(0.0)
        SaveAnimation(path, layout, ImageResolution=list(size), FrameRate=rate,
                      FrameWindow=[0, len(times) - 1])

    def follow(self, rock, times):
        """Where a camera stands and looks that moves along with a rock, without its bounces."""
        own = self.paths.of(rock)
        even = np.arange(-3.0, times[-1] + 3.0, 0.1)
        weights = np.hanning(41) / np.hanning(41).sum()
        path = self.paths.places(rock, even)
        calm = np.stack([np.convolve(np.pad(path[:, k], 20, mode="edge"), weights, mode="valid")
                         for k in range(3)], -1)
        targets = np.stack([np.interp(times, even, calm[:, k]) for k in range(3)], -1)
        side = np.radians(50.0)
        ahead = np.array([self.down[0] * np.cos(side) - self.down[1] * np.sin(side),
                          self.down[0] * np.sin(side) + self.down[1] * np.cos(side)])
        eyes = targets + np.append(14.0 * ahead, 4.0)
        eyes[:, 2] = np.maximum(eyes[:, 2], self.ground.height(eyes[:, 0], eyes[:, 1]) + 3.0)
        return eyes, targets
