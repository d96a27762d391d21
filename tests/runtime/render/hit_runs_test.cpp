#include "runtime/render/hit_runs.h"

#include <doctest/doctest.h>

#include <array>
#include <random>

namespace probe::render {
namespace {

constexpr std::size_t kHits = 37;  // whole vectors and a rest
using Floats = std::array<float, kHits>;

// A triangle a metre before a camera, hits all over it, and a turned instance.
struct Run {
  TriangleData triangle{};
  Instance instance;
  float origin[4] = {0.3f, -0.2f, 1.1f, 0};
  Floats dx, dy, dz, t, u, v;

  Run() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> some(-1, 1);
    for (auto* vector : {triangle.n0, triangle.n1, triangle.n2, triangle.g}) {
      for (int k = 0; k < 3; ++k) vector[k] = some(random);
    }
    triangle.e1[0] = 1.5f;
    triangle.e2[1] = 1.25f;
    for (auto* uv : {triangle.uv0, triangle.uv1, triangle.uv2}) {
      for (int k = 0; k < 2; ++k) uv[k] = 3 * some(random);
    }
    const Mat3 turn = Quat(0.5, 0.1, -0.7, 0.3).normalized().toRotationMatrix();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        instance.rows[r][c] = instance.columns[c][r] = static_cast<float>(turn(r, c));
      }
    }
    for (std::size_t i = 0; i < kHits; ++i) {
      const Vec3 to(0.3 + 0.3 * some(random) - origin[0], 0.3 + 0.3 * some(random) - origin[1],
                    -origin[2]);
      const Vec3 d = turn * to.normalized();
      dx[i] = static_cast<float>(d.x());
      dy[i] = static_cast<float>(d.y());
      dz[i] = static_cast<float>(d.z());
      // Every fifth is not to be trusted.
      t[i] = static_cast<float>(to.norm()) + (i % 5 == 0 ? 0.01f : 1e-4f * some(random));
      u[i] = 0.3f + 0.2f * some(random);
      v[i] = 0.3f + 0.2f * some(random);
    }
  }
  RunRays rays(std::size_t first) const { return {&dx[first], &dy[first], &dz[first]}; }
};

TEST_CASE("hits of a run are recomputed to the bits of each alone, and doubtful ones are kept") {
  Run together, apart;
  refine_run(together.triangle, together.instance, together.origin, together.rays(0), kHits,
             together.t.data(), together.u.data(), together.v.data());
  const Run before;
  for (std::size_t i = 0; i < kHits; ++i) {
    CAPTURE(i);
    refine_run(apart.triangle, apart.instance, apart.origin, apart.rays(i), 1, &apart.t[i],
               &apart.u[i], &apart.v[i]);
    CHECK((together.t[i] == before.t[i]) == (i % 5 == 0));
    CHECK((together.u[i] == before.u[i]) == (i % 5 == 0));
  }
  CHECK(together.t == apart.t);
  CHECK(together.u == apart.u);
  CHECK(together.v == apart.v);
}

TEST_CASE("normals of a run are those of each hit alone") {
  const Run run;
  std::array<Floats, 7> together{}, apart{};
  const auto out = [](std::array<Floats, 7>& a, std::size_t i) {
    return RunNormals{&a[0][i], &a[1][i], &a[2][i], &a[3][i], &a[4][i], &a[5][i], &a[6][i]};
  };
  turn_run(run.triangle, run.instance, run.rays(0), kHits, run.u.data(), run.v.data(),
           out(together, 0));
  for (std::size_t i = 0; i < kHits; ++i) {
    turn_run(run.triangle, run.instance, run.rays(i), 1, &run.u[i], &run.v[i], out(apart, i));
  }
  CHECK(together == apart);
  CHECK(together[4][0] == -run.dx[0]);
}

TEST_CASE("texels of a run lie in the texture, wrap, and are those of each hit alone") {
  const Run run;
  scene::Texture texture;
  texture.width = 5;
  texture.height = 3;
  std::array<std::array<std::uint32_t, kHits>, 4> together{}, apart{};
  std::array<Floats, 2> weights{}, weights_apart{};
  place_run(run.triangle, texture, kHits, run.u.data(), run.v.data(),
            {together[0].data(), together[1].data(), together[2].data(), together[3].data(),
             weights[0].data(), weights[1].data()});
  for (std::size_t i = 0; i < kHits; ++i) {
    CAPTURE(i);
    place_run(run.triangle, texture, 1, &run.u[i], &run.v[i],
              {&apart[0][i], &apart[1][i], &apart[2][i], &apart[3][i], &weights_apart[0][i],
               &weights_apart[1][i]});
    for (const auto& corner : together) CHECK(corner[i] < 15);
    CHECK(together[1][i] / 5 == together[0][i] / 5);
    CHECK(together[1][i] % 5 == (together[0][i] + 1) % 5);
    CHECK(together[2][i] % 5 == together[0][i] % 5);
    CHECK(together[2][i] / 5 == (together[0][i] / 5 + 1) % 3);
  }
  CHECK(together == apart);
  CHECK(weights == weights_apart);
}

}  // namespace
}  // namespace probe::render
