"""tf.image.resize(image, size, "lanczos3", antialias=True), rounded, by its formula in double precision:
a dense matrix a side, nothing shared with runtime/servers/resize_tf.cpp. Prints rows of pixels as
tests/runtime/servers/tf_lanczos3.txt holds them: picture, width, height, row, bytes in hexadecimal.

    /usr/bin/python3 tests/servers/tf_lanczos3.py > tests/runtime/servers/tf_lanczos3.txt
"""
import numpy

SIZES = {"small": [(3, 2), (4, 5), (10, 8), (7, 3), (7, 5), (1, 1)],
         "camera": [(224, 224), (256, 256), (320, 240), (640, 480), (800, 600), (500, 480)]}


def picture(name):
    """Those of resize_test.cpp."""
    if name == "small":
        i = numpy.arange(7 * 5 * 3)
        return ((i * 37 + i * i % 91) % 256).reshape(5, 7, 3).astype(float)
    y, x, c = numpy.mgrid[0:480, 0:640, 0:3]
    return ((x * 3 + y * 5 + c * 71 + x * y % 97) % 256).astype(float)


def matrix(size, wanted):
    scale = size / wanted
    wide = max(scale, 1)  # antialias: the kernel is as wide as the reduction
    far = (numpy.arange(size)[None, :] + 0.5 - (numpy.arange(wanted)[:, None] + 0.5) * scale) / wide
    weights = numpy.where(abs(far) <= 3, numpy.sinc(far) * numpy.sinc(far / 3), 0)
    return weights / weights.sum(axis=1, keepdims=True)


for name, sizes in SIZES.items():
    image = picture(name)
    for width, height in sizes:
        resized = numpy.einsum("yr,rxc->yxc", matrix(image.shape[0], height), image)
        resized = numpy.einsum("xs,ysc->yxc", matrix(image.shape[1], width), resized)
        resized = numpy.clip(numpy.rint(resized), 0, 255).astype("u1")
        rows = range(height) if name == "small" else [0, height // 3, height - 1]
        for row in rows:
            print(name, width, height, row, resized[row].tobytes().hex())
