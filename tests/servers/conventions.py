"""Our actions in the convention of raw BridgeData: roll pitch yaw, gripper 0 closed to 1 open."""
import numpy


def to_bridge(actions):
    out = numpy.array(actions, dtype=numpy.float64)
    for row in out:
        row[3:6] = rpy_of(row[3:6])
        row[6] = (row[6] + 1) / 2
    return out


def rpy_of(vector):
    angle = numpy.linalg.norm(vector)
    if angle == 0:
        return numpy.zeros(3)
    x, y, z = vector / angle
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    r = numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross
    return numpy.array([numpy.arctan2(r[2, 1], r[2, 2]), numpy.arcsin(-r[2, 0]),
                        numpy.arctan2(r[1, 0], r[0, 0])])
