// Meshes in their places as one camera sees them, drawn as triangles into a SampleBuffer.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/render/sample_buffer.h"
#include "runtime/render/vertex_law.h"
#include "runtime/render/vertex_mesh.h"

namespace probe::render {

// Columns [left, right) that something may have been drawn in, by row.
class RowSpans {
 public:
  struct Span {
    int left = 0, right = 0;
  };
  void clear(int height) { rows_.assign(static_cast<std::size_t>(height), {}); }
  void add(int top, int bottom, int left, int right);  // the last ones too
  const std::vector<Span>& rows() const { return rows_; }

 private:
  std::vector<Span> rows_;
};

// One picture's worth of visuals, statics and then what moves.
class PlacedMeshes {
 public:
  static constexpr float kNearestDepth = 0.01f;  // m; what is nearer is cut off

  Status add(const std::vector<Visual>& visuals,
             std::span<const std::shared_ptr<const VertexMesh>> meshes);
  const std::string& name(std::size_t instance) const { return instances_[instance].name; }
  void look_from(const Camera& camera);
  // A flat metal that moves with a visual: its plane in world, and the pixels it may be seen in.
  struct Mirror {
    std::size_t instance = 0;
    Vec3 normal = Vec3::UnitZ();
    double height = 0;                             // normal . p of what lies in it
    float share = 0;                               // of colours that it gives back
    std::uint32_t first_id = 0, end_id = 0;        // of its triangles
    int left = 0, right = 0, top = 0, bottom = 0;  // the last ones too
    bool may_be_at(int x, int y) const {
      return left <= x && x <= right && top <= y && y <= bottom;
    }
    bool holds(std::uint32_t id) const { return first_id <= id && id < end_id; }
    // Of a pixel's four samples.
    bool is_in(const std::uint32_t* ids) const {
      return holds(ids[0]) || holds(ids[1]) || holds(ids[2]) || holds(ids[3]);
    }
    // To the pixels of it that show it, where the scene is drawn; whether there are any.
    bool narrow(const SampleBuffer& seen);
  };
  // The first that the camera sees the front of, none else: as MuJoCo has it.
  std::optional<Mirror> mirror() const;
  // From the same eye into the mirror: nothing but what is before it, drawn left for right, and
  // only where the mirror may be seen.
  void look_into(const Camera& camera, const Mirror& mirror);
  // `pose` of a visual, world; its light has to be found anew.
  void place(std::size_t instance, const Pose& pose, const LampTable& lamps);
  // `spans` gets where it may be, if it is not null. Its triangles have numbers from 1 on, in the
  // order of visuals, parts and indices.
  void draw(std::size_t instance, SampleBuffer& out, RowSpans* spans);
  // All of them where they are, what is near first: much of the rest is hidden then and left out.
  // But for the mirror that is looked into.
  void draw_all(SampleBuffer& out);

  struct Instance {
    std::shared_ptr<const VertexMesh> mesh;
    Pose origin;
    std::uint16_t body = 0;
    std::string name;
    std::size_t first_part = 0;
    LampsThere lamps;
    Pose place;                   // mesh to world
    std::array<float, 9> turn{};  // mesh to camera, by rows
    std::array<float, 3> shift{};
    Float3 up =
        Float3::Zero();  // of the mirror that is looked into: p is before it where up . p is
    float level = 0;     // above this
    Float3 to_camera(const Float3& point) const;
  };
  struct PlacedPart {
    std::size_t instance = 0;
    const VertexMesh::Part* part = nullptr;
    std::size_t first_corner = 0;  // of all corners
    std::uint32_t first_id = 1, end_id = 1;
  };
  const std::vector<Instance>& instances() const { return instances_; }
  const std::vector<PlacedPart>& parts() const { return parts_; }
  // That has the triangle.
  std::size_t part_of(std::uint32_t id) const {
    std::size_t part = part_at_[id / kIdsTogether];
    while (id >= parts_[part].end_id) ++part;
    return part;
  }

  // Of a pixel's middle.
  float across(int x) const { return across_[static_cast<std::size_t>(x)]; }
  float down(int y) const { return down_[static_cast<std::size_t>(y)]; }
  // Of pixels of a row, from that one on.
  const float* across_from(int x) const { return &across_[static_cast<std::size_t>(x)]; }
  // How far a step of a pixel goes.
  float step_across() const { return step_across_; }
  float step_down() const { return step_down_; }

 private:
  bool is_outside(const Instance& instance, const Ball& ball) const;
  bool meets_mirror(const Instance& instance, const Ball& ball) const;
  DrawnCorner corner_at(const Float3& seen) const;
  void draw_part(const PlacedPart& placed, SampleBuffer& out, RowSpans* spans) const;
  void draw_cluster(const Instance& instance, const PlacedPart& placed,
                    const MeshClusters::Cluster& cluster, SampleBuffer& out, RowSpans* spans) const;
  void draw_cut(const Instance& instance, const VertexMesh::Part& part, std::size_t first,
                SampleBuffer& out, std::uint32_t id) const;

  std::vector<Instance> instances_;
  std::vector<PlacedPart> parts_;
  static constexpr std::uint32_t kIdsTogether = 64;
  std::vector<std::uint32_t> part_at_;  // that has the first of so many numbers, or ends before it
  Vec3 eye_ = Vec3::Zero();             // of light; of a mirror's picture behind it
  Mat3 to_eye_ = Mat3::Identity();      // world to right, down, forward
  Vec3 shift_ = Vec3::Zero();           // after that
  Vec3 forward_ = Vec3::UnitX();
  std::optional<Mirror> into_;
  float left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;  // pixels that count
  int width_ = 0, height_ = 0;
  float fx_ = 1, fy_ = 1, cx_ = 0, cy_ = 0;
  std::vector<float> across_, down_;  // by column and by row
  float step_across_ = 1, step_down_ = 1;
  std::vector<std::pair<float, std::size_t>> order_;  // of parts, by depth
  std::size_t corners_ = 0;
  std::uint32_t end_id_ = 1;
};

}  // namespace probe::render
