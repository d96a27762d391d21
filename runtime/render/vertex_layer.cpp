#include "runtime/render/vertex_layer.h"

#include <algorithm>
#include <array>
#include <limits>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

// So many pixels that what is found of their triangles stays near the processor.
constexpr std::size_t kTogether = 512;
constexpr std::size_t kAhead = 16;  // pixels: a row of a tile
static_assert(4 * kTogether <= SeenFragments::kMost);

bool is_inside(const SeenFace& face, float across, float down) {
  bool is_in = true;
  for (const Rgb& edge : face.edge)
    is_in = is_in && (edge[0] * across + edge[1] * down + edge[2]) * face.volume >= 0;
  return is_in;
}

// How many of `count` pixels from the first on show `id` in all samples.
PROBE_CLONES std::size_t run_of(const std::uint32_t* ids, std::size_t count, std::uint32_t id) {
  constexpr std::size_t kStep = 4;
  std::size_t run = 0;
  for (; run + kStep <= count; run += kStep) {
    std::uint32_t other = 0;
    for (std::size_t i = 0; i < 4 * kStep; ++i) other |= ids[4 * run + i] ^ id;
    if (other != 0) break;
  }
  for (; run < count; ++run) {
    const std::uint32_t* const of = ids + 4 * run;
    if (((of[0] ^ id) | (of[1] ^ id) | (of[2] ^ id) | (of[3] ^ id)) != 0) break;
  }
  return run;
}

// Bytes of pixels that follow each other in a row, one fragment each, and their depths; whether
// these are depths.
PROBE_CLONES bool write_run(const std::uint8_t* __restrict red,
                            const std::uint8_t* __restrict green,
                            const std::uint8_t* __restrict blue, const float* __restrict depth,
                            std::size_t count, std::uint8_t* __restrict rgb,
                            float* __restrict depths) {
  for (std::size_t i = 0; i < count; ++i) {
    rgb[3 * i] = red[i];
    rgb[3 * i + 1] = green[i];
    rgb[3 * i + 2] = blue[i];
  }
  std::int32_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    depths[i] = depth[i];
    wrong |= depth[i] > 0 && depth[i] <= std::numeric_limits<float>::max() ? 0 : 1;
  }
  return wrong == 0;
}

// From here on pixels that follow each other are worked on together.
constexpr std::size_t kRowRun = 4;

}  // namespace

void VertexLayer::show(std::span<const PixelAt> pixels,
                       const std::optional<PlacedMeshes::Mirror>& mirror, VertexLayer& mirrored,
                       Picture& picture) {
  if (!mirror) return show_own(pixels, nullptr, nullptr, picture);
  mirror_pixels_.clear();
  for (const PixelAt pixel : pixels) {
    if (mirror->may_be_at(pixel.x, pixel.y) && mirror->is_in(buffer_.ids(pixel.x, pixel.y)))
      mirror_pixels_.push_back(pixel);
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

// How many pixels of a row of a tile follow each other from there on.
std::size_t VertexLayer::row_from(std::span<const PixelAt> pixels, std::size_t first) {
  const std::size_t most = std::min(kAhead - pixels[first].x % kAhead, pixels.size() - first);
  for (std::size_t count = most; count > 1; --count) {
    const PixelAt last = pixels[first + count - 1];
    if (last.y == pixels[first].y && last.x == pixels[first].x + count - 1) return count;
  }
  return 1;
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
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    const PixelAt pixel = pixels[p];
    const PixelAt ahead = pixels[std::min(p + kAhead, pixels.size() - 1)];
    __builtin_prefetch(buffer_.ids(ahead.x, ahead.y));
    const std::uint32_t* ids = buffer_.ids(pixel.x, pixel.y);
    const float across = meshes_.across(pixel.x), down = meshes_.down(pixel.y);
    if (((ids[0] ^ ids[1]) | (ids[0] ^ ids[2]) | (ids[0] ^ ids[3])) == 0) {
      if (const std::size_t most = row_from(pixels, p); most >= kRowRun) {
        const std::size_t run = run_of(ids, most, ids[0]);
        std::fill_n(&arrays.face[count], run, slot_of(ids[0]));
        std::fill_n(&arrays.samples[count], run, 4);
        std::copy_n(meshes_.across_from(pixel.x), run, &arrays.across[count]);
        std::fill_n(&arrays.down[count], run, down);
        for (std::size_t k = 0; k < run; ++k) ends_[p + k] = static_cast<std::uint32_t>(++count);
        p += run - 1;
        continue;
      }
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
    if (!mirror.may_be_at(pixels[i].x, pixels[i].y)) {
      first = ends_[i];
      continue;
    }
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
  // Bytes may be anybody's: what is read on the way is named here, once.
  const std::uint32_t *const ends = ends_.data(), *const faces = arrays.face.data();
  const std::uint8_t *const red = arrays.byte[0].data(), *const green = arrays.byte[1].data(),
                            *const blue = arrays.byte[2].data();
  const float* const depth_of = arrays.depth.data();
  const auto width = static_cast<std::size_t>(picture.width);
  std::size_t first = 0;
  std::uint32_t last = SeenFaces::kNothing;
  std::uint16_t body = 0;  // of `last`
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t end = ends[i], at = pixels[i].y * width + pixels[i].x;
    if (end - first == 1) {
      // Its neighbours in the row, as long as they show the same triangle alone.
      std::size_t run = 1;
      const std::size_t most = std::min(kAhead, pixels.size() - i);
      while (run < most && ends[i + run] == end + run && faces[first + run] == faces[first] &&
             pixels[i + run].x == pixels[i].x + run && pixels[i + run].y == pixels[i].y)
        ++run;
      if (run >= kRowRun && write_run(red + first, green + first, blue + first, depth_of + first,
                                      run, colors + 3 * at, depths + at)) {
        std::fill_n(bodies + at, run, faces_[faces[first]].body);
        first += run;
        i += run - 1;
        continue;
      }
    }
    std::size_t middle = first;
    std::uint8_t* const rgb = colors + 3 * at;
    if (end - first == 1) {
      rgb[0] = red[first];
      rgb[1] = green[first];
      rgb[2] = blue[first];
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        int sum = 2;
        for (std::size_t f = first; f < end; ++f) sum += arrays.samples[f] * arrays.byte[k][f];
        rgb[k] = static_cast<std::uint8_t>(sum / 4);
      }
      middle = middle_of(first, end);
    }
    first = end;
    const std::uint32_t face = faces[middle];
    if (face != last) {
      last = face;
      body = faces_[face].body;
    }
    bodies[at] = body;
    const float depth = depth_of[middle];
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
