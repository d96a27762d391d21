// The collision shape of a rigid body: convex parts with mass properties. Made once per asset, shared by worlds.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::scene {

// A convex polyhedron of at most 64 vertices, 128 faces, 160 edges; or a ball (one vertex) or capsule (two) of radius
// `round` about its vertices, without faces and edges. Coordinates are relative to the shape's centre of mass, in the
// model frame's axes.
struct ConvexPart {
  struct Face {
    Vec3 normal;
    double offset = 0;  // largest normal . vertex
    std::vector<std::uint8_t> loop;  // vertex indices, counter-clockwise seen from outside
  };
  struct Edge {
    std::uint8_t a = 0, b = 0;
    Vec3 normal_a, normal_b;  // of the two faces
  };
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<Edge> edges;
  double round = 0;             // m, above 0 only for balls and capsules
  std::vector<double> x, y, z;  // vertices again, padded to a multiple of 4 with vertex 0
  Vec3 center = Vec3::Zero();   // of the local box
  Vec3 half = Vec3::Zero();
};

struct CollisionShape {
  std::vector<ConvexPart> parts;
  Vec3 center_of_mass = Vec3::Zero();    // in the model frame
  double volume = 0;                     // m3
  Mat3 unit_inertia = Mat3::Zero();      // about the centre of mass, for density 1: kg m2 per (kg/m3)
  double bounding_radius = 0;            // about the centre of mass
};

}  // namespace probe::scene
