// What is said of many small triangles at once is what drawing each alone says.
#include "runtime/render/seen_triangles.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace probe::render {
namespace {

// Of random corners around places of a picture, `side` subpixels apart at most.
struct Crowd {
  std::vector<std::int32_t> x, y;
  std::vector<float> nearness;
  std::array<std::vector<std::uint16_t>, 3> corner;

  Crowd(std::mt19937& random, int side) {
    std::uniform_int_distribution<int> place(-700, 32 * kSubpixels + 700), off(0, side);
    std::uniform_real_distribution<float> near(0.5f, 2);
    for (std::size_t i = 0; i < SmallTriangles::kMost; ++i) {
      const int left = place(random), top = place(random);
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k].push_back(static_cast<std::uint16_t>(x.size()));
        x.push_back(left + off(random));
        y.push_back(top + off(random));
        nearness.push_back(near(random));
      }
    }
  }
  SmallTriangles triangles() const {
    return {x.data(),
            y.data(),
            nearness.data(),
            {corner[0].data(), corner[1].data(), corner[2].data()},
            corner[0].size()};
  }
  DrawnCorner at(std::size_t k, std::size_t i) const {
    const std::size_t c = corner[k][i];
    return {x[c], y[c], nearness[c]};
  }
};

int differing(const SampleBuffer& a, const SampleBuffer& b) {
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      for (int k = 0; k < 4; ++k)
        count += a.ids(x, y)[k] != b.ids(x, y)[k] || a.nearness(x, y)[k] != b.nearness(x, y)[k];
    }
  }
  return count;
}

}  // namespace

TEST_CASE("many small triangles at once show what each shows that is drawn alone") {
  std::mt19937 random(11);
  for (const bool smooth : {true, false}) {
    for (const int side : {3, 40, 120, 255, 256, 300, 600, 900, 40000}) {
      CAPTURE(side);
      SampleBuffer alone, together;
      alone.resize(32, 32, smooth);
      together.resize(32, 32, smooth);
      std::size_t left_out = 0;
      std::array<std::size_t, SampleBuffer::kBoxes.size()> boxed{};
      for (int round = 0; round < 30; ++round) {
        const Crowd crowd(random, side);
        SeenTriangles seen;
        find_seen(crowd.triangles(), together, seen);
        const auto id = [&](std::size_t i) {
          return static_cast<std::uint32_t>(
              1 + i + SmallTriangles::kMost * static_cast<std::size_t>(round));
        };
        for (std::size_t i = 0; i < SmallTriangles::kMost; ++i)
          alone.draw(crowd.at(0, i), crowd.at(1, i), crowd.at(2, i), id(i));
        for (std::size_t n = 0; n < seen.to_draw.count; ++n) {
          const std::size_t i = seen.to_draw.which[n];
          together.draw(crowd.at(0, i), crowd.at(1, i), crowd.at(2, i), id(i));
        }
        std::vector<std::uint32_t> numbers;
        for (std::size_t i = 0; i < SmallTriangles::kMost; ++i) numbers.push_back(id(i));
        for (std::size_t k = 0; k < seen.boxed.size(); ++k) {
          together.draw_boxed(crowd.triangles(), seen.boxed[k], k, 0, numbers.data());
          boxed[k] += seen.boxed[k].count;
          left_out -= seen.boxed[k].count;
        }
        left_out += SmallTriangles::kMost - seen.to_draw.count;
      }
      CHECK(differing(alone, together) == 0);
      if (side <= 300) CHECK(left_out > 30 * SmallTriangles::kMost / 3);
      if (side == 600) CHECK(*std::ranges::min_element(boxed) > 0);
    }
  }
}

TEST_CASE(
    "the order of drawing does not show: of equally near triangles the greatest number stays") {
  std::mt19937 random(3);
  Crowd crowd(random, 6000);
  for (float& near : crowd.nearness) near = 1;
  SampleBuffer forwards, backwards;
  forwards.resize(32, 32, true);
  backwards.resize(32, 32, true);
  for (std::size_t i = 0; i < SmallTriangles::kMost; ++i) {
    const std::size_t k = SmallTriangles::kMost - 1 - i;
    forwards.draw(crowd.at(0, i), crowd.at(1, i), crowd.at(2, i),
                  static_cast<std::uint32_t>(i + 1));
    backwards.draw(crowd.at(0, k), crowd.at(1, k), crowd.at(2, k),
                   static_cast<std::uint32_t>(k + 1));
  }
  CHECK(differing(forwards, backwards) == 0);
}

}  // namespace probe::render
