#include "runtime/render/vertex_layer.h"

#include <algorithm>
#include <array>
#include <limits>

namespace probe::render {
namespace {

// So many pixels that what is found of their triangles stays near the processor.
constexpr std::size_t kTogether = 512;
static_assert(4 * kTogether <= SeenFragments::kMost);

bool is_inside(const SeenFace& face, float across, float down) {
  bool is_in = true;
  for (const Rgb& edge : face.edge)
    is_in = is_in && (edge[0] * across + edge[1] * down + edge[2]) * face.volume >= 0;
  return is_in;
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
  ends_.resize(pixels.size());
  auto& arrays = fragments_.arrays();
  std::size_t count = 0;
  std::uint32_t last = 0, slot = SeenFaces::kNothing;
  const auto slot_of = [&](std::uint32_t id) {
    if (id != last) {
      last = id;
      slot = faces_.ask(id);
    }
    return slot;
  };
  const auto add = [&](std::uint32_t id, int samples, float across, float down) {
    arrays.face[count] = slot_of(id);
    arrays.samples[count] = samples;
    arrays.across[count] = across;
    arrays.down[count++] = down;
  };
  constexpr std::size_t kAhead = 16;  // pixels: a row of a tile
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    const PixelAt pixel = pixels[p];
    const PixelAt ahead = pixels[std::min(p + kAhead, pixels.size() - 1)];
    __builtin_prefetch(buffer_.ids(ahead.x, ahead.y));
    const std::uint32_t* ids = buffer_.ids(pixel.x, pixel.y);
    const float across = meshes_.across(pixel.x), down = meshes_.down(pixel.y);
    if (((ids[0] ^ ids[1]) | (ids[0] ^ ids[2]) | (ids[0] ^ ids[3])) == 0) {
      add(ids[0], 4, across, down);
    } else {
      for (int i = 0; i < 4; ++i) {
        if (std::find(ids, ids + i, ids[i]) != ids + i) continue;
        add(ids[i], static_cast<int>(std::count(ids + i, ids + 4, ids[i])), across, down);
      }
    }
    ends_[p] = static_cast<std::uint32_t>(count);
  }
  fragments_.resize(count);
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
  std::uint8_t* const colors = picture.rgb.data();
  float* const depths = picture.depth.data();
  std::uint16_t* const bodies = picture.segmentation.data();
  std::size_t first = 0;
  std::uint32_t last = SeenFaces::kNothing;
  std::uint16_t body = 0;  // of `last`
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t end = ends_[i], at = picture.at(pixels[i].x, pixels[i].y);
    std::size_t middle = first;
    std::uint8_t* const rgb = colors + 3 * at;
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
    const std::uint32_t face = arrays.face[middle];
    if (face != last) {
      last = face;
      body = faces_[face].body;
    }
    bodies[at] = body;
    const float depth = arrays.depth[middle];
    if (depth > 0 && depth <= std::numeric_limits<float>::max()) {
      depths[at] = depth;
    } else {
      depths[at] =
          face == SeenFaces::kNothing ? 0 : 1 / *buffer_.nearness(pixels[i].x, pixels[i].y);
    }
  }
}

// The triangle in the middle of a pixel: of the body that has most of its samples, and else of any,
// the nearest that holds it, else the one of most samples. A body of many small triangles may have
// none in a sample that holds the middle, while a table behind it has one in all.
std::size_t VertexLayer::middle_of(std::size_t first, std::size_t end) const {
  const auto& arrays = fragments_.arrays();
  std::array<const SeenFace*, 4> faces;
  const std::size_t count = end - first;
  for (std::size_t f = 0; f < count; ++f) faces[f] = &faces_[arrays.face[first + f]];
  constexpr int kMost = 3;  // of four samples
  // Of that body alone; where none has most, of all.
  bool is_any = true;
  std::uint16_t wanted = 0;
  for (std::size_t f = 0; f < count && is_any; ++f) {
    int samples = 0;
    for (std::size_t g = 0; g < count; ++g)
      samples += faces[g]->body == faces[f]->body ? arrays.samples[first + g] : 0;
    is_any = samples < kMost;
    wanted = faces[f]->body;
  }
  const auto counts = [&](std::size_t f) { return is_any || faces[f]->body == wanted; };
  std::size_t inside = count, most = 0;
  float nearest = 0;
  for (std::size_t f = 0; f < count; ++f) {
    if (!counts(f)) continue;
    if (!counts(most)) most = f;
    if (arrays.samples[first + f] > arrays.samples[first + most]) most = f;
    if (faces[f]->id == 0) continue;
    const float nearness = arrays.denominator[first + f] / faces[f]->volume;
    if (nearness > nearest &&
        is_inside(*faces[f], arrays.across[first + f], arrays.down[first + f])) {
      nearest = nearness;
      inside = f;
    }
  }
  return first + (inside != count ? inside : most);
}

}  // namespace probe::render
