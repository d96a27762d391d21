// A scene drawn by the vertex law: triangles in samples, and the bytes of pixels that show them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "runtime/render/picture.h"
#include "runtime/render/placed_mesh.h"
#include "runtime/render/sample_buffer.h"
#include "runtime/render/seen_faces.h"

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
  // Where a mirror is seen, `mirrored` is what it shows; null: none is.
  void show(std::span<const PixelAt> pixels, VertexLayer* mirrored, Picture& picture);

 private:
  // What one triangle shows in a pixel.
  struct Fragment {
    Rgb color;             // 0 .. 255
    const SeenFace* face;  // null: nothing is there
    float denominator;
    int samples;  // of the pixel's
  };
  // Fragments of one texture, and where it is read for them.
  struct Textured {
    const MipChain* texture = nullptr;
    std::vector<std::uint32_t> fragment;
    std::vector<float> u, v, texels;
  };

  void find_faces(std::span<const PixelAt> pixels);
  void add_fragment(const SeenFace& face, int samples, PixelAt at);
  void read_textures();
  void show_some(std::span<const PixelAt> pixels, VertexLayer* mirrored, Picture& picture);
  const Fragment& middle_of(std::span<const Fragment> pixel, PixelAt at) const;

  PlacedMeshes meshes_;
  SampleBuffer buffer_;
  SeenFaces faces_;
  std::vector<Fragment> fragments_;
  std::vector<std::uint32_t> ends_;  // in fragments_, by pixel
  std::vector<Textured> textured_;
  std::size_t last_textured_ = 0;  // neighbours are mostly of one texture
  std::vector<float> texels_;
  Picture reflected_;  // a layer that is mirrored shows itself here
};

}  // namespace probe::render
