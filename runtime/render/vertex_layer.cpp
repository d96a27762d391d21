#include "runtime/render/vertex_layer.h"

#include <algorithm>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

// So many pixels that what is found of their triangles stays near the processor.
constexpr std::size_t kTogether = 512;
constexpr std::size_t kAhead = 16;  // pixels: a row of a tile
static_assert(kTogether <= SeenRows::kMost && kTogether <= MixedPixels::kMost);
static_assert(4 * kTogether <= SeenFaces::kMost);

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

// From here on pixels that follow each other are worked on together.
constexpr std::size_t kRowRun = 6;

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
    sort_out(some);
    faces_.find(meshes_);
    const PixelStep step{meshes_.step_across(), meshes_.step_down()};
    rows_.light(faces_, step);
    mixed_.light(faces_, step);
    if (mirror != nullptr) add_reflected(*mirror, *reflected);
    rows_.write(faces_, buffer_, picture);
    mixed_.write(faces_, buffer_, picture);
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

// Pixels that show one triangle alone, as their neighbours do, and the others.
void VertexLayer::sort_out(std::span<const PixelAt> pixels) {
  faces_.begin(meshes_);
  rows_.clear();
  mixed_.clear();
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    const PixelAt pixel = pixels[p];
    const PixelAt ahead = pixels[std::min(p + kAhead, pixels.size() - 1)];
    __builtin_prefetch(buffer_.ids(ahead.x, ahead.y));
    const std::uint32_t* ids = buffer_.ids(pixel.x, pixel.y);
    const float down = meshes_.down(pixel.y);
    if (((ids[0] ^ ids[1]) | (ids[0] ^ ids[2]) | (ids[0] ^ ids[3])) == 0) {
      const std::size_t run = run_of(ids, row_from(pixels, p), ids[0]);
      if (run >= kRowRun) {
        rows_.add(faces_.ask(ids[0]), pixel.x, pixel.y, run, meshes_.across_from(pixel.x), down);
        p += run - 1;
        continue;
      }
    }
    mixed_.add(pixel.x, pixel.y, meshes_.across(pixel.x), down, ids, faces_);
  }
}

void VertexLayer::add_reflected(const PlacedMeshes::Mirror& mirror, const Picture& reflected) {
  const auto seen_at = [&](int x, int y) { return &reflected.rgb[3 * reflected.at(x, y)]; };
  for (const SeenRows::Row& row : rows_.rows()) {
    if (!mirror.holds(faces_[row.face].id)) continue;
    for (std::size_t i = 0; i < row.count; ++i)
      rows_.add_light(row, i, seen_at(row.x + static_cast<int>(i), row.y));
  }
  mixed_.add_light(
      faces_, [&](std::uint32_t id) { return mirror.holds(id); }, seen_at);
}

}  // namespace probe::render
