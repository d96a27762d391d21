// A scene drawn by the vertex law: triangles in samples, and the bytes of pixels that show them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "runtime/render/mixed_pixels.h"
#include "runtime/render/picture.h"
#include "runtime/render/placed_mesh.h"
#include "runtime/render/sample_buffer.h"
#include "runtime/render/seen_faces.h"
#include "runtime/render/seen_rows.h"

namespace probe::render {

struct PixelAt {
  std::uint16_t x = 0, y = 0;
};

class VertexLayer {
 public:
  explicit VertexLayer(PlacedMeshes meshes) : meshes_(std::move(meshes)) {}

  PlacedMeshes& meshes() { return meshes_; }
  const PlacedMeshes& meshes() const { return meshes_; }
  SampleBuffer& buffer() { return buffer_; }
  const SampleBuffer& buffer() const { return buffer_; }

  // What pixels, neighbours together, show of what is drawn: colour, depth and id, into `picture`.
  // Where `mirror` is seen, what `mirrored` shows is added.
  void show(std::span<const PixelAt> pixels, const std::optional<PlacedMeshes::Mirror>& mirror,
            VertexLayer& mirrored, Picture& picture);

 private:
  void show_own(std::span<const PixelAt> pixels, const PlacedMeshes::Mirror* mirror,
                const Picture* reflected, Picture& picture);
  static std::size_t row_from(std::span<const PixelAt> pixels, std::size_t first);
  void sort_out(std::span<const PixelAt> pixels);
  void add_reflected(const PlacedMeshes::Mirror& mirror, const Picture& reflected);

  PlacedMeshes meshes_;
  SampleBuffer buffer_;
  SeenFaces faces_;
  SeenRows rows_;
  MixedPixels mixed_;
  std::vector<PixelAt> mirror_pixels_;
  Picture reflected_;  // a layer that is mirrored shows itself here
};

}  // namespace probe::render
