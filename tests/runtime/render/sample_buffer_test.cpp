// What is hidden is left out, and nothing else.
#include "runtime/render/sample_buffer.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace probe::render {
namespace {

constexpr int kWidth = 100, kHeight = 70;  // its last tiles are cut

struct Triangle {
  std::array<DrawnCorner, 3> corner;
};

// Fronts of any size: specks and what fills the picture and more.
std::vector<Triangle> some_triangles(int count) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  std::vector<Triangle> out;
  while (out.size() < static_cast<std::size_t>(count)) {
    const double x = between(-20, kWidth + 20), y = between(-20, kHeight + 20);
    const double size = out.size() % 9 == 0 ? 200 : between(1, 20), depth = between(0.2, 3);
    Triangle made;
    for (DrawnCorner& corner : made.corner) {
      corner.x = static_cast<std::int32_t>(kSubpixels * (x + between(-size, size)));
      corner.y = static_cast<std::int32_t>(kSubpixels * (y + between(-size, size)));
      corner.nearness = static_cast<float>(1 / (depth + between(0, 0.3)));
    }
    out.push_back(made);
  }
  return out;
}

void draw(const Triangle& triangle, std::uint32_t id, SampleBuffer& out) {
  const auto& [a, b, c] = triangle.corner;
  out.draw(a, b, c, id);
  out.draw(a, c, b, id);  // one of both is a front
}

int differing(const SampleBuffer& a, const SampleBuffer& b) {
  int out = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      out += std::equal(a.ids(x, y), a.ids(x, y) + 4, b.ids(x, y)) &&
                     std::equal(a.nearness(x, y), a.nearness(x, y) + 4, b.nearness(x, y))
                 ? 0
                 : 1;
  }
  return out;
}

}  // namespace

TEST_CASE("what is found hidden could not have shown: a picture without it has the same samples") {
  const auto triangles = some_triangles(600);
  SampleBuffer plain, asked;
  plain.resize(kWidth, kHeight, true);
  asked.resize(kWidth, kHeight, true);
  int hidden = 0;
  const auto draw_all = [&](std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) {
      draw(triangles[i], i + 1, plain);
      const auto& corners = triangles[i].corner;
      const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
      const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
      const auto column = [](int at) { return std::clamp(at / kSubpixels, 0, kWidth - 1); };
      const auto row = [](int at) { return std::clamp(at / kSubpixels, 0, kHeight - 1); };
      const float nearest =
          std::max({corners[0].nearness, corners[1].nearness, corners[2].nearness});
      if (asked.hides(column(left), column(right), row(top), row(bottom), nearest)) {
        ++hidden;
      } else {
        draw(triangles[i], i + 1, asked);
      }
    }
  };
  draw_all(0, 400);
  CHECK(differing(plain, asked) == 0);
  CHECK(hidden > 100);
  // What was hidden shows again where the rest is taken away.
  for (SampleBuffer* buffer : {&plain, &asked}) buffer->clear(20, 60, 11, 50);
  SampleBuffer empty;
  empty.resize(kWidth, kHeight, true);
  for (SampleBuffer* buffer : {&plain, &asked}) buffer->restore(empty, 60, 5, 90);
  draw_all(400, 600);
  CHECK(differing(plain, asked) == 0);
}

TEST_CASE("what is drawn into a part of a picture is what the whole picture shows there") {
  constexpr int kLeft = 21, kRight = 60, kTop = 13, kBottom = 44;
  SampleBuffer whole, part;
  whole.resize(kWidth, kHeight, true);
  part.resize(kWidth, kHeight, true);
  part.clear(kLeft, kRight, kTop, kBottom);
  std::uint32_t id = 0;
  for (const Triangle& triangle : some_triangles(400)) {
    draw(triangle, ++id, whole);
    draw(triangle, id, part);
  }
  int there = 0;
  for (int y = kTop; y <= kBottom; ++y) {
    for (int x = kLeft; x <= kRight; ++x) {
      for (int k = 0; k < 4; ++k)
        there += whole.ids(x, y)[k] == part.ids(x, y)[k] &&
                 whole.nearness(x, y)[k] == part.nearness(x, y)[k];
    }
  }
  CHECK(there == 4 * (kRight - kLeft + 1) * (kBottom - kTop + 1));
  CHECK(part.ids(kLeft - 10, kTop - 10)[0] == 0);
}

}  // namespace probe::render
