// Meshes in their places as one camera sees them: drawn as triangles into a SampleBuffer, and what
// each triangle that is seen shows anywhere in the picture.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
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

// What a triangle shows where the ray (across, down, 1) meets its plane: numerators that are linear
// in across and down, over a denominator that is, too.
struct SeenFace {
  std::uint32_t id = 0;
  Rgb by_across{}, by_down{}, at_middle{};     // red, green, blue 0 .. 1, and the denominator
  std::array<float, 3> u{}, v{};               // by across, by down, in the middle
  std::array<std::array<float, 3>, 3> edge{};  // what each corner's share comes from, alike
  float volume = 0;                            // depth (m) = volume / denominator
  Rgb mean{};                                  // where the plane is not before the eye
  const MipChain* texture = nullptr;
  std::uint16_t body = 0;  // as segmentation has it
  float mirror = 0;
};

// Counted from 1 on: 0 is nothing.
struct DrawnTriangle {
  std::uint32_t part = 0, triangle = 0;
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
    int left = 0, right = 0, top = 0, bottom = 0;  // the last ones too
  };
  // The first that the camera sees the front of, none else: as MuJoCo has it.
  std::optional<Mirror> mirror() const;
  // From the same eye into the mirror: nothing but what is before it, drawn left for right, and
  // only where the mirror may be seen.
  void look_into(const Camera& camera, const Mirror& mirror);
  // `pose` of a visual, world; its light has to be found anew.
  void place(std::size_t instance, const Pose& pose, const LampTable& lamps);
  // Adds what of it is seen to `drawn`; `spans` gets where it may be, if it is not null.
  void draw(std::size_t instance, SampleBuffer& out, std::vector<DrawnTriangle>& drawn,
            RowSpans* spans);
  // `id` is what draw() gave it; `drawn` what it added to.
  SeenFace face(std::uint32_t id, const DrawnTriangle& drawn);

  // Of a pixel's middle.
  float across(int x) const { return (static_cast<float>(x) + 0.5f - cx_) / fx_; }
  float down(int y) const { return (static_cast<float>(y) + 0.5f - cy_) / fy_; }
  float fx() const { return fx_; }
  float fy() const { return fy_; }

 private:
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
        Float3::Zero();       // of the mirror that is looked into: p is before it where up . p is
    float level = 0;          // above this
    std::uint32_t stamp = 0;  // of its light
  };
  struct PlacedPart {
    std::size_t instance = 0;
    const VertexMesh::Part* part = nullptr;
    std::size_t first_corner = 0;  // in lit_
  };

  Float3 to_camera(const Instance& instance, const Float3& point) const;
  bool is_outside(const Instance& instance, const VertexMesh::Part& part) const;
  DrawnCorner corner_at(const Float3& seen) const;
  bool draw_cut(const Instance& instance, const VertexMesh::Part& part, std::size_t first,
                SampleBuffer& out, std::uint32_t id) const;
  const Rgb& lit(const PlacedPart& placed, std::uint32_t corner);

  std::vector<Instance> instances_;
  std::vector<PlacedPart> parts_;
  Vec3 eye_ = Vec3::Zero();         // of light; of a mirror's picture behind it
  Mat3 to_eye_ = Mat3::Identity();  // world to right, down, forward
  Vec3 shift_ = Vec3::Zero();       // after that
  Vec3 forward_ = Vec3::UnitX();
  std::optional<Mirror> into_;
  float left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;  // pixels that count
  int width_ = 0, height_ = 0;
  float fx_ = 1, fy_ = 1, cx_ = 0, cy_ = 0;
  std::uint32_t stamps_ = 0;
  std::vector<Rgb> lit_;
  std::vector<std::uint32_t> lit_stamp_;
  std::vector<std::int32_t> x_, y_;  // of the part that is drawn
  std::vector<float> nearness_;
};

}  // namespace probe::render
