"""A drop that rings: theory of small amplitudes, and a fit of frequency and damping to what was measured.

[Prosperetti 1980] Normal-mode analysis for the oscillations of a viscous liquid drop in an immiscible liquid. J. Mecanique 19.
"""

import cmath
import math


def solved(rows):
    """Gauss: the x of rows (a | b), pivots by rows."""
    n = len(rows)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [p - factor * q for p, q in zip(rows[i], rows[k])]
    x = [0] * n
    for k in reversed(range(n)):
        x[k] = (rows[k][n] - sum(rows[k][j] * x[j] for j in range(k + 1, n))) / rows[k][k]
    return x


def misfit(course, frequency, damping):
    """The sum of squares that is left of exp(-damping t) (a cos + b sin) + c, at best."""
    base = [(math.exp(-damping * t) * math.cos(frequency * t), math.exp(-damping * t) * math.sin(frequency * t), 1)
            for t, _ in course]
    rows = [[sum(p[i] * p[j] for p in base) for j in range(3)] + [sum(p[i] * q for p, (_, q) in zip(base, course))]
            for i in range(3)]
    best = solved(rows)
    return sum((q - sum(b * p for b, p in zip(best, ps))) ** 2 for ps, (_, q) in zip(base, course))


def fitted(course, frequency, damping):
    """Frequency and damping of a course of (time, value), looked for from these on."""
    at, step = [frequency, damping], [0.1 * frequency, 0.5 * damping]
    best = misfit(course, *at)
    while max(step) > 1e-7:
        for k, sign in ((0, 1), (0, -1), (1, 1), (1, -1)):
            tried = list(at)
            tried[k] += sign * step[k]
            left = misfit(course, *tried)
            if left < best:
                best, at = left, tried
                break
        else:
            step = [s / 2 for s in step]
    return at


def viscous_inside(n, z):
    """The modified spherical Bessel function i_n and its derivative."""
    below, here = cmath.cosh(z) / z, cmath.sinh(z) / z
    for k in range(n):
        below, here = here, below - (2 * k + 1) / z * here
    return here, below - (n + 1) / z * here


def viscous_outside(n, z):
    """k_n, but for a factor, and its derivative."""
    below = here = cmath.exp(-z) / z
    for k in range(n):
        below, here = here, below + (2 * k + 1) / z * here
    return here, -below - (n + 1) / z * here


def stresses(n, s, density, viscosity, radial):
    """At the surface, of a flow with the radial velocity R(r) Y and R, R', R'' there as given, and its pressure: velocity
    across and along, stress along and across it."""
    value, slope, bend, pressure = radial
    m = n * (n + 1)
    along, along_slope = (2 * value + slope) / m, (2 * slope + bend + slope) / m
    return value, along, viscosity * (along_slope - along + value), -pressure + 2 * viscosity * slope


def columns(n, s, density, viscosity, outside):
    """Those of the potential flow and of the viscous one."""
    power = -n - 2 if outside else n - 1
    pressure = density * s / (n + 1) if outside else -density * s / n
    k = cmath.sqrt(s * density / viscosity)
    f, g = (viscous_outside if outside else viscous_inside)(n, k)
    value, slope = 1, k * g / f  # of the function itself, its value 1
    bend = -2 * slope + (k * k + n * (n + 1)) * value
    viscous = (value, slope - value, bend - 2 * slope + 2 * value, 0)  # of it by r
    return [stresses(n, s, density, viscosity, radial)
            for radial in ((1, power, power * (power - 1), pressure), viscous)]


def unbalanced(n, s, density, viscosity):
    """What is left of the balance of stresses across the surface, by its velocity: zero where s is a mode's."""
    inside = columns(n, s, density[0], viscosity[0], False)
    outside = columns(n, s, density[1], viscosity[1], True)
    signed = [(c, 1) for c in inside] + [(c, -1) for c in outside]
    rows = [[sign * c[i] for c, sign in signed] + [0] for i in range(3)]
    rows.append([c[0] for c in inside] + [0, 0, 1])
    amount = solved(rows)
    jump = sum(a * sign * c[3] for a, (c, sign) in zip(amount, signed))
    return jump + (n - 1) * (n + 2) / s


def normal_mode(n, density, viscosity):
    """Frequency and damping of the mode n of a drop of radius 1 and tension 1, of (inside, outside)."""
    natural = math.sqrt(n * (n - 1) * (n + 1) * (n + 2) / ((n + 1) * density[0] + n * density[1]))
    damping = (n - 1) * (2 * n + 1) * viscosity[0] / density[0]
    before, here = complex(-damping, natural), complex(-0.9 * damping, 0.99 * natural)
    value = unbalanced(n, before, density, viscosity)
    for _ in range(50):
        now = unbalanced(n, here, density, viscosity)
        if abs(here - before) < 1e-13 * abs(here) or now == value:
            break
        before, value, here = here, now, here - now * (here - before) / (now - value)
    return here.imag, -here.real
