# SPDX-License-Identifier: GPL-3.0-or-later

"""The same model in other units of length: every dimensionless result must be the same.

If lengths scale with s at constant Young's moduli, densities and pressures, frequencies, rates and speeds scale with 1 / s, forces with
s^2, mount stiffnesses per area with 1 / s, and damping coefficients of contact nodes with s^2.
"""

LENGTHS = {"Disc inner radius": 0.2, "Disc outer radius": 0.3155, "Disc thickness": 0.0463, "Pin diameter": 0.052, "Pin height": 0.0318,
           "Element size": 0.0577, "Top pin radii": 0.257, "Bottom pin radii": 0.257, "Pairing tolerance": 1e-6}
MOUNT = (0, 7.8e10, 1.88e10)


def scaled(s, *, held=True, damped=False):
    """Settings of the small model with lengths scaled by s."""
    settings = [f"Geometry/{name}={value * s!r}" for name, value in LENGTHS.items()]
    settings += [f"Band/Maximum frequency={5000 / s!r}", f"Operation/Load per side={1000 * s**2!r}", f"Operation/Rotation speed={4 / s!r}"]
    stiffnesses = ", ".join(repr(stiffness / s) for stiffness in MOUNT)
    settings.append(f"Mounts/Elastic mounts={f'disc_bore: {stiffnesses}' if held else ''}")
    if damped:
        settings += ["Operation/Radial dissipation=consistent", f"Disc material/Rayleigh beta={1e-7 * s!r}", f"Pin material/Rayleigh alpha={20 / s!r}"]
    return tuple(settings)


def difference(rows, others, s):
    """Largest difference between two tables of modes, where the second model has s times the lengths of the first: relative to
    the frequency for frequencies and growth rates, absolute for dimensionless numbers. Infinite if texts or the numbers of rows differ."""
    if len(rows) != len(others):
        return float("inf")
    largest = 0.0
    for row, other in zip(rows, others):
        for column, cell in row.items():
            try:
                one, two = float(cell), float(other[column])
            except ValueError:
                if cell != other[column]:
                    return float("inf")
                continue
            if column in ("frequency [Hz]", "growth rate [1/s]"):
                largest = max(largest, abs(one - s * two) / (float(row["frequency [Hz]"]) or 1.0))
            else:
                largest = max(largest, abs(one - two) / (100 if "[%]" in column else 1))
    return largest
