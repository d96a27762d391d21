#include "runtime/render/vertex_layer.h"

#include <algorithm>
#include <cmath>

namespace probe::render {
namespace {

// So many pixels that what is found of their triangles stays near the processor.
constexpr std::size_t kTogether = 512;
static_assert(4 * kTogether <= SeenFragments::kMost);

bool is_inside(const SeenFace& face, float across, float down) {
  return std::ranges::all_of(face.edge, [&](const Rgb& edge) {
    return (edge[0] * across + edge[1] * down + edge[2]) * face.volume >= 0;
  });
}

}  // namespace

void VertexLayer::show(std::span<const PixelAt> pixels,
                       const std::optional<PlacedMeshes::Mirror>& mirror, VertexLayer& mirrored,
                       Picture& picture) {
  if (!mirror) return show_own(pixels, nullptr, nullptr, picture);
  mirror_pixels_.clear();
  for (const PixelAt pixel : pixels) {
    if (mirror->is_in(buffer_.ids(pixel.x, pixel.y))) mirror_pixels_.push_back(pixel);
  }
  mirrored.reflected_.resize(picture.width, picture.height);
  mirrored.show_own(mirror_pixels_, nullptr, nullptr, mirrored.reflected_);
  show_own(pixels, &*mirror, &mirrored.reflected_, picture);
}

void VertexLayer::show_own(std::span<const PixelAt> pixels, const PlacedMeshes::Mirror* mirror,
                           const Picture* reflected, Picture& picture) {
  for (std::size_t first = 0; first < pixels.size(); first += kTogether) {
    const auto some = pixels.subspan(first, std::min(kTogether, pixels.size() - first));
    find_fragments(some);
    faces_.find(meshes_);
    fragments_.light(faces_, meshes_.step_across(), meshes_.step_down());
    if (mirror != nullptr) add_reflected(some, *mirror, *reflected);
    fragments_.round();
    write(some, picture);
  }
}

void VertexLayer::find_fragments(std::span<const PixelAt> pixels) {
  faces_.begin(meshes_);
  fragments_.clear();
  ends_.clear();
  std::uint32_t last = 0, slot = SeenFaces::kNothing;
  const auto slot_of = [&](std::uint32_t id) {
    if (id != last) {
      last = id;
      slot = faces_.ask(id);
    }
    return slot;
  };
  for (const PixelAt pixel : pixels) {
    const std::uint32_t* ids = buffer_.ids(pixel.x, pixel.y);
    const float across = meshes_.across(pixel.x), down = meshes_.down(pixel.y);
    if (ids[0] == ids[1] && ids[0] == ids[2] && ids[0] == ids[3]) {
      fragments_.add(slot_of(ids[0]), 4, across, down);
    } else {
      for (int i = 0; i < 4; ++i) {
        if (std::find(ids, ids + i, ids[i]) != ids + i) continue;
        fragments_.add(slot_of(ids[i]), static_cast<int>(std::count(ids + i, ids + 4, ids[i])),
                       across, down);
      }
    }
    ends_.push_back(static_cast<std::uint32_t>(fragments_.size()));
  }
}

void VertexLayer::add_reflected(std::span<const PixelAt> pixels, const PlacedMeshes::Mirror& mirror,
                                const Picture& reflected) {
  auto& arrays = fragments_.arrays();
  std::size_t first = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (; first < ends_[i]; ++first) {
      if (!mirror.holds(faces_[arrays.face[first]].id)) continue;
      const std::uint8_t* seen = &reflected.rgb[3 * reflected.at(pixels[i].x, pixels[i].y)];
      for (std::size_t k = 0; k < 3; ++k) arrays.color[k][first] += static_cast<float>(seen[k]);
    }
  }
}

void VertexLayer::write(std::span<const PixelAt> pixels, Picture& picture) const {
  const auto& arrays = fragments_.arrays();
  std::size_t first = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t end = ends_[i], at = picture.at(pixels[i].x, pixels[i].y);
    std::size_t middle = first;
    std::uint8_t* const rgb = &picture.rgb[3 * at];
    if (end - first == 1) {
      for (std::size_t k = 0; k < 3; ++k) rgb[k] = arrays.byte[k][first];
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        int sum = 2;
        for (std::size_t f = first; f < end; ++f) sum += arrays.samples[f] * arrays.byte[k][f];
        rgb[k] = static_cast<std::uint8_t>(sum / 4);
      }
      middle = middle_of(first, end);
    }
    first = end;
    if (arrays.face[middle] == SeenFaces::kNothing) {
      picture.depth[at] = 0;
      picture.segmentation[at] = 0;
      continue;
    }
    const float depth = arrays.depth[middle];
    picture.depth[at] =
        depth > 0 && std::isfinite(depth) ? depth : 1 / *buffer_.nearness(pixels[i].x, pixels[i].y);
    picture.segmentation[at] = faces_[arrays.face[middle]].body;
  }
}

// The triangle in the middle of a pixel: of the body that has most of its samples, and else of any,
// the nearest that holds it, else the one of most samples. A body of many small triangles may have
// none in a sample that holds the middle, while a table behind it has one in all.
std::size_t VertexLayer::middle_of(std::size_t first, std::size_t end) const {
  const auto& arrays = fragments_.arrays();
  const auto body_of = [&](std::size_t f) { return int{faces_[arrays.face[f]].body}; };
  const auto samples_of = [&](int body) {
    int samples = 0;
    for (std::size_t f = first; f < end; ++f) samples += body_of(f) == body ? arrays.samples[f] : 0;
    return samples;
  };
  constexpr int kMost = 3, kAny = -1;  // of four samples
  int wanted = kAny;
  for (std::size_t f = first; f < end && wanted == kAny; ++f) {
    if (samples_of(body_of(f)) >= kMost) wanted = body_of(f);
  }
  std::size_t inside = end, most = first;
  float nearest = 0;
  for (std::size_t f = first; f < end; ++f) {
    if (wanted != kAny && body_of(f) != wanted) continue;
    if (wanted != kAny && body_of(most) != wanted) most = f;
    if (arrays.samples[f] > arrays.samples[most]) most = f;
    const SeenFace& face = faces_[arrays.face[f]];
    if (face.id == 0 || !is_inside(face, arrays.across[f], arrays.down[f])) continue;
    const float nearness = arrays.denominator[f] / face.volume;
    if (nearness > nearest) {
      nearest = nearness;
      inside = f;
    }
  }
  return inside != end ? inside : most;
}

}  // namespace probe::render
