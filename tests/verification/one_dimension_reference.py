"""The material point method in one dimension, written anew with dense matrices: a standing wave in
a periodic unit length, in the law of linear eos and hypoelasticity at Poisson's ratio 0."""
import numpy


def shape_function(shape, distance, half):
    """Values and slopes of a node's function at `distance` from it, in cells; `half` is half the
    length of the points' domains (gimp)."""
    x, side = numpy.abs(distance), numpy.sign(distance)
    if shape == "linear":
        # at a node itself the slope is that of the cell above it
        slope = numpy.where((distance >= -1) & (distance < 0), 1.0,
                            numpy.where((distance >= 0) & (distance < 1), -1.0, 0.0))
        return numpy.maximum(1 - x, 0), slope
    if shape == "gimp":
        def integral(a):  # of the hat function, from minus infinity
            b = numpy.clip(a, -1, 1)
            return numpy.where(b < 0, 0.5 * (1 + b) ** 2, 1 - 0.5 * (1 - b) ** 2)

        def hat(a):
            return numpy.maximum(1 - numpy.abs(a), 0)
        return ((integral(distance + half) - integral(distance - half)) / (2 * half),
                (hat(distance + half) - hat(distance - half)) / (2 * half))
    if shape == "quadratic":
        return (numpy.where(x < 0.5, 0.75 - x ** 2, numpy.maximum(1.5 - x, 0) ** 2 / 2),
                numpy.where(x < 0.5, -2 * distance, -side * numpy.maximum(1.5 - x, 0)))
    return (numpy.where(x < 1, 2 / 3 - x ** 2 + x ** 3 / 2, numpy.maximum(2 - x, 0) ** 3 / 6),
            numpy.where(x < 1, -2 * distance + 1.5 * distance * x,
                        -side * numpy.maximum(2 - x, 0) ** 2 / 2))


class Wave:
    """`cells` of unit length together, `points` in each, v = speed sin(2 pi x), modulus and density
    1. `transfer`: (model, number)."""

    def __init__(self, cells, shape, transfer, order, speed, points=2, fixed=False):
        self.cells, self.shape, self.transfer, self.order = cells, shape, transfer, order
        count = cells * points
        self.x = (numpy.arange(count) + 0.5) / count
        self.v = speed * numpy.sin(2 * numpy.pi * self.x)
        self.stretch = numpy.ones(count)
        self.deviator = numpy.zeros(count)
        self.affine = numpy.zeros(count)
        self.mass = 1.0 / count
        self.length = numpy.full(count, cells / count)
        self.fixed = fixed

    def away(self):
        """Distances of points from nodes, in cells, the short way round."""
        apart = self.x[None, :] * self.cells - numpy.arange(self.cells)[:, None]
        return apart - self.cells * numpy.round(apart / self.cells)

    def weights(self):
        value, slope = shape_function(self.shape, self.away(), 0.5 * self.length)
        return value, slope * self.cells

    def stress(self):
        return (1 - 1 / self.stretch) / 3 + self.deviator

    def strain(self, gradient, step):
        g = step * gradient
        self.stretch = self.stretch * (1 + g)
        if not self.fixed:
            self.length = self.length * (1 + g)
        self.deviator = self.deviator + 2 / 3 * g / (1 + 0.5 * g)

    def momentum(self, value):
        offset = -self.away() / self.cells
        if self.transfer[0] != "apic":
            return value @ (self.mass * self.v)
        slope = self.affine / (value * offset ** 2).sum(axis=0)
        return (value * (self.v + slope * offset)).sum(axis=1) * self.mass

    def velocities(self, value, before, after):
        """New velocities of the points, from the nodes' before and after the update."""
        model, number = self.transfer
        gathered = value.T @ after
        if model == "apic":
            offset = -self.away() / self.cells
            self.affine = (value * offset).T @ after  # its second moment is that of the scatter
            return gathered
        if model == "flip":
            return (1 - number) * (self.v + value.T @ (after - before)) + number * gathered
        mass, rest = value.sum(axis=1), self.v
        for _ in range(number):  # what is left when the nodes' view is taken away, again and again
            rest = rest - value.T @ ((value @ rest) / mass)
        return self.v - rest + value.T @ (after - before)

    def step(self, step):
        value, slope = self.weights()
        mass = self.mass * value.sum(axis=1)
        before = self.momentum(value) / mass
        force = -slope @ (self.mass * self.stretch * self.stress())
        after = before + step * force / mass
        self.v = self.velocities(value, before, after)
        if self.order == "usl":
            self.strain(slope.T @ after, step)
        if self.order == "musl":
            self.strain(slope.T @ (self.momentum(value) / mass), step)
        self.x = self.x + step * (value.T @ after)
        if self.order == "usf":  # the strain that stands before the next step's force
            value, slope = self.weights()
            self.strain(slope.T @ (self.momentum(value) / (self.mass * value.sum(axis=1))), step)
