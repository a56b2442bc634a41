#!/usr/bin/env pvpython
# SPDX-License-Identifier: GPL-3.0-or-later

"""Writes ParaView sessions, pictures or films of modes.

    scripts/paraview_modes.py RESULTS --state FILE.pvsm                   all modes; open with: paraview FILE.pvsm
    scripts/paraview_modes.py RESULTS --mode A0-4 --state FILE.pvsm       the motion of one mode
    scripts/paraview_modes.py RESULTS [--mode MODE] --pictures FOLDER     a picture of each mode, or of the chosen modes
    scripts/paraview_modes.py RESULTS --mode MODE --film FILE.gif         the motion, including its growth

With all modes, the time buttons step through the modes by frequency [Hz], each deformed by its real part. With one
mode, the time buttons play Re(phi e^(lambda t)), including growth, for --periods periods. The largest displacement is drawn as --size times
the radius of the disc. MODE is a row of complex_modes.csv, counted from 1, or a label, which selects its fastest
growing mode. Colours show the amplitude; the title shows mode, frequency, effective damping ratio and verdict. Views
are iso, top, side, below; faces, the upper pins seen from below without the disc, with the normal reactions on their
contact faces; and energy, the same faces with their contribution to the divergence rate of a growing mode.

Requires Debian's paraview, python3-paraview, xvfb and xauth (scripts/setup.sh paraview). Without a display, the script restarts under xvfb-run.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from paraview_scenes import VIEWS, WIDTH, scene_of_all, scene_of_energy, scene_of_one, write_film
from squeal.command_line import Parser, ensure_display, exit_on_error
from squeal.errors import Error
from squeal.results import Table, shape_files


def rows_of(results):
    """Rows of complex_modes.csv."""
    if not (results / "complex_modes.csv").is_file():
        raise Error("there is no complex_modes.csv", results, "name the folder of a stability run")
    return Table(results / "complex_modes.csv").rows


def title_of(row):
    """Title of a mode: "A0-4 +,  2353.0 Hz,  effective damping ratio -1.36 %,  unstable"."""
    verdict = row.get("verdict") or ("unstable" if row["unstable [-]"] == "1" else "not unstable")
    ratio = float(row["effective damping ratio -2R/omega [%]"])
    return f"{row['label']},  {float(row['frequency [Hz]']):.1f} Hz,  effective damping ratio {ratio:.3g} %,  {verdict}"


def files_of(results):
    """Files of the mode shapes by row of complex_modes.csv."""
    found = shape_files(results)
    if not found:
        raise Error("there are no shapes of complex modes", results, "run again with Output/Mode shapes = all")
    return found


def chosen(name, rows, files):
    """Row number of a mode that is given by row or label."""
    if name.isdigit():
        number = int(name)
        if not 1 <= number <= len(rows):
            raise Error(f"there is no row {name}", "--mode", f"choose from rows 1 to {len(rows)} of complex_modes.csv")
    else:
        own = [number for number, row in enumerate(rows, start=1) if name in (row["label"], row["label"].split(" ")[0])]
        if not own:
            raise Error(f"no mode has the label {name}", "--mode", f"name one of: {', '.join(sorted({row['label'] for row in rows}))}")
        number = max(own, key=lambda one: float(rows[one - 1]["growth rate [1/s]"]))
    if number not in files:
        raise Error(f"the shape of row {number} was not written", f"--mode {name}", "run again with Output/Mode shapes = all")
    return number


def parsed():
    parser = Parser(__doc__)
    parser.add_argument("results", metavar="RESULTS", type=pathlib.Path)
    parser.add_argument("--mode", action="append", metavar="MODE", help="row of complex_modes.csv or label; may be repeated for pictures")
    parser.add_argument("--state", type=pathlib.Path, metavar="FILE.pvsm")
    parser.add_argument("--pictures", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--film", type=pathlib.Path, metavar="FILE.gif")
    parser.add_argument("--view", choices=tuple(VIEWS), default="iso", help="(default: %(default)s)")
    parser.add_argument("--size", type=float, default=0.08, help="largest displacement over the radius of the disc (default: %(default)s)")
    parser.add_argument("--periods", type=int, default=2, help="periods of the motion of a mode (default: %(default)s)")
    parser.add_argument("--width", type=int, default=WIDTH, help="width of pictures [pixels] (default: %(default)s)")
    arguments = parser.parse_args()
    if not (arguments.state or arguments.pictures or arguments.film):
        parser.error("nothing to do: give --state, --pictures or --film")
    if arguments.film and len(arguments.mode or ()) != 1:
        parser.error("--film shows one mode: give --mode once")
    if arguments.state and len(arguments.mode or ()) > 1:
        parser.error("--state shows all modes or one: give --mode at most once")
    if arguments.view in ("faces", "energy") and (arguments.film or arguments.state and (arguments.mode or arguments.view == "energy")):
        parser.error(f"--view {arguments.view} is not available for this film or session: use --pictures")
    if arguments.periods < 1 or arguments.width < 1 or not arguments.size > 0:
        parser.error("--periods, --width and --size must be positive")
    return arguments


def write_pictures(simple, results, numbers, rows, files, titles, arguments):
    """Writes pictures of the chosen modes or of all modes with shapes; the view `energy` shows growing modes only."""
    shows_energy = arguments.view == "energy"
    shown = [number for number in numbers or sorted(files) if not shows_energy or rows[number - 1]["unstable [-]"] == "1"]
    if shows_energy and (not shown or set(numbers) - set(shown)):
        raise Error("--view energy requires growing modes" + ("" if numbers else ", and none grows"), "--mode",
                    "choose a growing mode or another --view")
    arguments.pictures.mkdir(parents=True, exist_ok=True)
    scene, times = (None, {}) if shows_energy else scene_of_all(simple, results, titles, files, arguments)
    for number in shown:
        path = arguments.pictures / f"{files[number].stem}{'_energy' if shows_energy else ''}.png"
        (scene or scene_of_energy(simple, files[number], titles[number], arguments)).save(path, times.get(number))
        print(path)
        if shows_energy:
            simple.ResetSession()


def write_session_and_film(simple, results, numbers, rows, files, titles, arguments):
    """Writes the requested session and film of one mode, or a session of all modes."""
    if numbers:
        number, = numbers
        scene, times = scene_of_one(simple, files[number], rows[number - 1], titles[number], arguments)
        if arguments.film:
            is_steady = float(rows[number - 1]["growth rate [1/s]"]) == 0
            write_film(scene, times[:-1] if is_steady else times, arguments.film)
            print(arguments.film)
    else:
        scene_of_all(simple, results, titles, files, arguments)
    if arguments.state:
        simple.SaveState(str(arguments.state))
        print(arguments.state)
    simple.ResetSession()


@exit_on_error()
def main():
    arguments = parsed()
    results = arguments.results.resolve()
    rows, files = rows_of(results), files_of(results)
    numbers = [chosen(name, rows, files) for name in arguments.mode or ()]
    titles = {number: title_of(rows[number - 1]) for number in files}
    ensure_display("paraview", ("pvpython",), "1600x1200x24 -noreset")
    from paraview import simple
    simple._DisableFirstRenderCameraReset()
    if arguments.state or arguments.film:
        write_session_and_film(simple, results, numbers, rows, files, titles, arguments)
    if arguments.pictures:
        write_pictures(simple, results, numbers, rows, files, titles, arguments)


if __name__ == "__main__":
    main()
