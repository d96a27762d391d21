#include "runtime/render/hit_runs.h"

#include <cmath>

#include "runtime/render/clones.h"
#include "runtime/scene/color.h"

namespace probe::render {
namespace {

struct Vec3f {
  float x, y, z;
};

inline Vec3f read3(const float* p) { return {p[0], p[1], p[2]}; }
inline float dot(const Vec3f& a, const Vec3f& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3f cross(const Vec3f& a, const Vec3f& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// a x + b y + c z.
inline Vec3f mix(const Vec3f& a, float x, const Vec3f& b, float y, const Vec3f& c, float z) {
  return {a.x * x + b.x * y + c.x * z, a.y * x + b.y * y + c.y * z, a.z * x + b.z * y + c.z * z};
}

// What is the same for all rays of a run.
struct RunPlane {
  Vec3f row0, row1, row2;  // of the rotation, mesh to world
  Vec3f e1, e2, s;         // edges, and the origin seen from the corner
  Vec3f q;                 // s x e1
  float height;            // dot(e2, q)
};

PROBE_CLONES void refine_all(const RunPlane& plane, const float* __restrict dx,
                             const float* __restrict dy, const float* __restrict dz,
                             std::size_t count, float* __restrict t, float* __restrict u,
                             float* __restrict v) {
  const RunPlane k = plane;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f d = mix(k.row0, dx[i], k.row1, dy[i], k.row2, dz[i]);
    const Vec3f p = cross(d, k.e2);
    const float inverse = 1.0f / dot(k.e1, p);
    const float exact_t = k.height * inverse;
    const bool trusted = (std::abs(exact_t - t[i]) < 1e-3f) | (t[i] == kUnknownDistance);
    float a = dot(k.s, p) * inverse, b = dot(d, k.q) * inverse;
    a = a < 0 ? 0 : a;
    a = 1 < a ? 1 : a;
    const float rest = 1.0f - a;
    b = b < 0 ? 0 : b;
    b = rest < b ? rest : b;
    t[i] = trusted ? exact_t : t[i];
    u[i] = trusted ? a : u[i];
    v[i] = trusted ? b : v[i];
  }
}

struct RunFace {
  Vec3f column0, column1, column2;  // of the rotation, mesh to world
  Vec3f n0, n1, n2;
  Vec3f g;  // world
};

PROBE_CLONES void turn_all(const RunFace& face, const float* __restrict dx,
                           const float* __restrict dy, const float* __restrict dz,
                           std::size_t count, const float* __restrict u, const float* __restrict v,
                           float* __restrict nx, float* __restrict ny, float* __restrict nz,
                           float* __restrict side, float* __restrict vx, float* __restrict vy,
                           float* __restrict vz) {
  const RunFace k = face;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f d{dx[i], dy[i], dz[i]};
    const float w = 1 - u[i] - v[i];
    const Vec3f m = mix(k.n0, w, k.n1, u[i], k.n2, v[i]);
    const Vec3f n = mix(k.column0, m.x, k.column1, m.y, k.column2, m.z);
    nx[i] = n.x;
    ny[i] = n.y;
    nz[i] = n.z;
    side[i] = dot(k.g, d) > 0 ? -1.0f : 1.0f;
    vx[i] = -d.x;
    vy[i] = -d.y;
    vz[i] = -d.z;
  }
}

PROBE_CLONES void place_all(const float* __restrict uv, int width, int height, std::size_t count,
                            const float* __restrict u, const float* __restrict v,
                            std::uint32_t* __restrict upper_left,
                            std::uint32_t* __restrict upper_right,
                            std::uint32_t* __restrict lower_left,
                            std::uint32_t* __restrict lower_right, float* __restrict across,
                            float* __restrict down) {
  const float u0 = uv[0], v0 = uv[1], u1 = uv[2], v1 = uv[3], u2 = uv[4], v2 = uv[5];
  const auto stride = static_cast<std::uint32_t>(width);
  for (std::size_t i = 0; i < count; ++i) {
    const float w = 1 - u[i] - v[i];
    const scene::Texels at = scene::texels_at(width, height, w * u0 + u[i] * u1 + v[i] * u2,
                                              w * v0 + u[i] * v1 + v[i] * v2);
    const std::uint32_t upper = stride * static_cast<std::uint32_t>(at.y0);
    const std::uint32_t lower = stride * static_cast<std::uint32_t>(at.y1);
    upper_left[i] = upper + static_cast<std::uint32_t>(at.x0);
    upper_right[i] = upper + static_cast<std::uint32_t>(at.x1);
    lower_left[i] = lower + static_cast<std::uint32_t>(at.x0);
    lower_right[i] = lower + static_cast<std::uint32_t>(at.x1);
    across[i] = at.across;
    down[i] = at.down;
  }
}

}  // namespace

void refine_run(const TriangleData& triangle, const Instance& instance, const float* origin,
                const RunRays& d, std::size_t count, float* t, float* u, float* v) {
  RunPlane plane{read3(instance.rows[0]),
                 read3(instance.rows[1]),
                 read3(instance.rows[2]),
                 read3(triangle.e1),
                 read3(triangle.e2),
                 {},
                 {},
                 0};
  plane.s = {origin[0] - triangle.p0[0], origin[1] - triangle.p0[1], origin[2] - triangle.p0[2]};
  plane.q = cross(plane.s, plane.e1);
  plane.height = dot(plane.e2, plane.q);
  refine_all(plane, d.x, d.y, d.z, count, t, u, v);
}

void turn_run(const TriangleData& triangle, const Instance& instance, const RunRays& d,
              std::size_t count, const float* u, const float* v, const RunNormals& out) {
  RunFace face{read3(instance.columns[0]),
               read3(instance.columns[1]),
               read3(instance.columns[2]),
               read3(triangle.n0),
               read3(triangle.n1),
               read3(triangle.n2),
               {}};
  face.g =
      mix(face.column0, triangle.g[0], face.column1, triangle.g[1], face.column2, triangle.g[2]);
  turn_all(face, d.x, d.y, d.z, count, u, v, out.nx, out.ny, out.nz, out.side, out.vx, out.vy,
           out.vz);
}

void place_run(const TriangleData& triangle, const scene::Texture& texture, std::size_t count,
               const float* u, const float* v, const RunTexels& out) {
  const float uv[6] = {triangle.uv0[0], triangle.uv0[1], triangle.uv1[0],
                       triangle.uv1[1], triangle.uv2[0], triangle.uv2[1]};
  place_all(uv, texture.width, texture.height, count, u, v, out.upper_left, out.upper_right,
            out.lower_left, out.lower_right, out.across, out.down);
}

}  // namespace probe::render
