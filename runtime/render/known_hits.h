// What rays of a frame meet among moving things, as far as it can be known without rays: their
// triangles, as placed, on a HitSheet.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/block_marks.h"
#include "runtime/render/camera_rays.h"
#include "runtime/render/cone_triangle.h"
#include "runtime/render/hit_sheet.h"
#include "runtime/render/projected_part.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

// What setting up a part's triangles takes; pixels and metres.
struct TriangleLimits {
  float nearest;       // depth: less is not seen
  float widest;        // vertices farther out are not trusted
  float max_x, max_y;  // last pixel
  // How wrong places may be, in Embree's arithmetic and in ours: at `distance` metres, and in
  // pixels at closeness w, of a triangle with coordinates up to c, (`pixels` + `grows` c) w +
  // kEdgeDoubt c.
  float distance, pixels, grows;
  float depth;  // how wrong a solid triangle's depth may be
};

class KnownHits {
 public:
  // Draws the instances, as placed, in the blocks that `marks` names for them. The same instances
  // in every call. Gives what is known, of marked blocks only: nothing where drawing would cost
  // more than the rays.
  KnownTriangles look(const std::vector<Instance>& instances, const Camera& camera,
                      const CameraRays& rays, const BlockMarks& marks);

 private:
  void name_all(const std::vector<Instance>& instances);
  void order(const std::vector<Instance>& instances, const Camera& camera);
  bool is_worth_it(const BlockMarks& marks);
  bool is_drawn(InstanceSet block) const { return block != 0 && (block & rest_) == 0; }
  void limit(const Instance& instance, const MeshGeometry::Part& part, const Projection& projection,
             const Camera& camera);
  void draw(const Instance& instance, const MeshGeometry::Part& part, std::uint32_t number,
            const BlockMarks& marks, InstanceSet bit);
  bool is_asked(const TriangleBatch& batch, std::size_t i, const BlockMarks& marks,
                InstanceSet bit);
  void add_doubtful(const Instance& instance, const MeshGeometry::Part& part, std::size_t index,
                    std::uint32_t number, const BlockMarks& marks, InstanceSet bit);
  bool add_cone(const Instance& instance, const MeshGeometry::Part& part, std::size_t index,
                const PixelBounds& bounds, std::uint32_t number, const BlockMarks& marks,
                InstanceSet bit);
  void flush_doubtful();

  TriangleLimits limits_{};
  ConeView cones_;
  struct Range {
    InstanceSet bit;
    std::size_t count;  // triangles
  };
  std::vector<Range> parts_;  // of all instances, in order
  struct Turn {
    float depth;  // m: of the instance's origin
    std::uint32_t instance;
  };
  std::vector<Turn> turns_;            // in which instances are drawn
  std::vector<std::uint32_t> first_;   // an instance each: its first triangle's number
  InstanceSet wanted_ = 0, rest_ = 0;  // of what is marked: drawn, and left to rays
  std::vector<TriangleName> names_;
  HitSheet sheet_;
  ProjectedPart part_;
  std::unique_ptr<TriangleBatch> batch_ = std::make_unique<TriangleBatch>();
  std::unique_ptr<TriangleBatch> doubtful_ = std::make_unique<TriangleBatch>();
};

}  // namespace probe::render
