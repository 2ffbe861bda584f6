"""Closed forms that docs/theory/exact_solutions.md derives, and the numbers that come of them."""
import math

import scenes  # before numpy: it skips the test where it is missing
import numpy


class Elastic:
    """An isotropic elastic solid, small strains."""

    def __init__(self, density, bulk_modulus, shear_modulus):
        self.density, self.bulk, self.shear = density, bulk_modulus, shear_modulus
        self.lame = bulk_modulus - 2.0 * shear_modulus / 3.0
        self.longitudinal = math.sqrt((self.lame + 2.0 * shear_modulus) / density)
        self.transverse = math.sqrt(shear_modulus / density)
        young = 9.0 * bulk_modulus * shear_modulus / (3.0 * bulk_modulus + shear_modulus)
        self.bar = math.sqrt(young / density)
        self.poisson = young / (2.0 * shear_modulus) - 1.0


def bisect(function, low, high):
    """A root between two places where the signs differ, to rounding."""
    below = function(low) > 0.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if (function(middle) > 0.0) == below:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


# ---- hollow cylinder and sphere, breathing ------------------------------------------------------

def breathing_shape(solid, inner, outer, curved, omega, steps=400):
    """Radii, displacement and radial stress of a radial motion at omega, free inside; `curved` is 1
    for a cylinder that cannot lengthen and 2 for a sphere. Runge and Kutta's fourth order."""
    stiff, lame, n = solid.lame + 2.0 * solid.shear, solid.lame, curved
    inertia = solid.density * omega ** 2

    def slope(r, u, radial):
        rate = (radial - n * lame * u / r) / stiff
        hoop = lame * rate + (stiff + (n - 1) * lame) * u / r
        return rate, -inertia * u - n * (radial - hoop) / r

    h = (outer - inner) / steps
    states = [(1.0, 0.0)]
    for i in range(steps):
        r, (u, s) = inner + i * h, states[-1]
        a = slope(r, u, s)
        b = slope(r + 0.5 * h, u + 0.5 * h * a[0], s + 0.5 * h * a[1])
        c = slope(r + 0.5 * h, u + 0.5 * h * b[0], s + 0.5 * h * b[1])
        d = slope(r + h, u + h * c[0], s + h * c[1])
        states.append(tuple(x + h * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]) / 6.0
                            for k, x in enumerate((u, s))))
    return [inner + i * h for i in range(steps + 1)], states


def breathing(solid, inner, outer, curved):
    """Circular frequency of the first mode, and coefficients of u / r in powers of
    (r - middle) / half the wall, highest first."""
    def outside(omega):
        return breathing_shape(solid, inner, outer, curved, omega)[1][-1][1]

    low = high = 0.2 * solid.longitudinal / (0.5 * (inner + outer))
    while (outside(low) > 0.0) == (outside(high) > 0.0):
        low, high = high, high * 1.1
    omega = bisect(outside, low, high)
    r, states = breathing_shape(solid, inner, outer, curved, omega)
    r, u = numpy.array(r), numpy.array([state[0] for state in states])
    place = (r - 0.5 * (inner + outer)) / (0.5 * (outer - inner))
    return omega, numpy.polyfit(place, u / r, 7)


# ---- longitudinal wave in a round bar -----------------------------------------------------------

def bessel(order, square, terms=40):
    """J0(z), or J1(z) / z, of z^2, which may be negative."""
    value = term = 1.0 if order == 0 else 0.5
    for m in range(1, terms):
        term *= -0.25 * square / (m * (m + order))
        value += term
    return value


def pochhammer(solid, radius, number):
    """Circular frequency of the first longitudinal mode with that wave number: the root nearest
    to that of a thin bar."""
    def squares(omega):
        return ((omega / solid.longitudinal) ** 2 - number ** 2,
                (omega / solid.transverse) ** 2 - number ** 2)

    def equation(omega):
        p, q = squares(omega)
        a, k = radius ** 2, number ** 2
        return (2.0 * (q + k) * p * bessel(1, p * a) * bessel(1, q * a)
                - (q - k) ** 2 * bessel(0, p * a) * bessel(1, q * a)
                - 4.0 * k * p * bessel(1, p * a) * bessel(0, q * a))

    thin = solid.bar * number
    guess = thin * (1.0 - 0.25 * (solid.poisson * number * radius) ** 2)
    omega = bisect(equation, 0.9 * guess, min(1.02 * thin, 1.1 * guess))
    return omega, squares(omega)


def pochhammer_mode(solid, radius, number, terms=8):
    """omega, and the mode as polynomials of r^2, lowest first: u_r / r over cos kz and u_z over
    sin kz."""
    omega, (p, q) = pochhammer(solid, radius, number)
    part = (2.0 * number * p * bessel(1, p * radius ** 2)
            / ((q - number ** 2) * bessel(1, q * radius ** 2)))

    def series(order, square):
        found, term = [], 1.0 if order == 0 else 0.5
        for m in range(terms):
            found.append(term)
            term *= -0.25 * square / ((m + 1) * (m + 1 + order))
        return numpy.array(found)

    radial = -p * series(1, p) - part * number * series(1, q)
    axial = -number * series(0, p) + part * series(0, q)
    return omega, radial, axial


# ---- collapse of a shell that does not change its volume -----------------------------------------

def collapse(density, yield_stress, inner, outer, curved, speed, steps=4000):
    """A rigid, perfectly plastic shell whose inner face moves in with `speed` at first: time and
    inner radius where it stops, and the radii of its outer face then. The energy balance
    d(kinetic) = - dissipation is integrated in the inner radius, by Simpson's rule."""
    n = curved
    whole = outer ** (n + 1) - inner ** (n + 1)

    def far(a):
        return (a ** (n + 1) + whole) ** (1.0 / (n + 1))

    def inertia(a):
        """Kinetic energy over half the square of c = a^n times the speed of the inner face."""
        b = far(a)
        return (2.0 * math.pi * density * math.log(b / a) if n == 1
                else 4.0 * math.pi * density * (1.0 / a - 1.0 / b))

    def resistance(a):
        """Dissipation a unit of c."""
        b = far(a)
        return (4.0 * math.pi / math.sqrt(3.0) * yield_stress * math.log(b / a) if n == 1
                else 8.0 * math.pi * yield_stress * math.log(b / a))

    # with E the kinetic energy, dE = resistance a^n da: dc dt = da a^n
    energy = 0.5 * inertia(inner) * (inner ** n * speed) ** 2
    a, time, h = inner, 0.0, inner / steps
    while a - h > 0.0:
        def taken(x):
            return resistance(x) * x ** n
        less = energy - h / 6.0 * (taken(a) + 4.0 * taken(a - 0.5 * h) + taken(a - h))
        if less <= 0.0:
            # what is left goes at a constant force
            rest = energy / taken(a)
            time += 2.0 * rest / (math.sqrt(2.0 * energy / inertia(a)) / a ** n)
            return time, a - rest, far(a - rest)
        before = math.sqrt(2.0 * energy / inertia(a)) / a ** n
        after = math.sqrt(2.0 * less / inertia(a - h)) / (a - h) ** n
        time += 2.0 * h / (before + after)
        a, energy = a - h, less
    raise ValueError("it closes")


def collapse_strain(first, inner, stopped, curved):
    """Plastic strain of material that was at radius `first`."""
    n = curved
    now = (first ** (n + 1) - inner ** (n + 1) + stopped ** (n + 1)) ** (1.0 / (n + 1))
    return (2.0 / math.sqrt(3.0) if n == 1 else 2.0) * numpy.log(first / now)
