#include "runtime/render/seen_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

using Arrays = SeenRows::Arrays;

// How far a step of a pixel goes, and how large a texture is.
struct Steps {
  float right, below, width, height;
};

// What a triangle shows in the middles of pixels.
PROBE_CLONES void show_run(const SeenFace& face, std::size_t first, std::size_t count, Arrays& a) {
  const float* __restrict const across = a.across.data() + first;
  const float* __restrict const down = a.down.data() + first;
  float* __restrict const denominators = a.denominator.data() + first;
  float* __restrict const depth = a.depth.data() + first;
  const float by_across = face.by_across[3], by_down = face.by_down[3],
              at_middle = face.at_middle[3], volume = face.volume;
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float denominator = by_across * across[i] + by_down * down[i] + at_middle;
    denominators[i] = denominator;
    depth[i] = volume / denominator;
  }
  for (int k = 0; k < 3; ++k) {
    float* __restrict const to = a.color[static_cast<std::size_t>(k)].data() + first;
    const float c_across = face.by_across[k], c_down = face.by_down[k],
                c_middle = face.at_middle[k], mean = face.mean[k];
    PROBE_INDEPENDENT
    for (std::size_t i = 0; i < count; ++i) {
      const float quotient = (c_across * across[i] + c_down * down[i] + c_middle) / denominators[i];
      const float color = denominators[i] * volume > 0 ? quotient : mean;
      to[i] = color > 0.0f ? (color < 1.0f ? color : 1.0f) : 0.0f;
    }
  }
}

// Where its texture is read there, and how many texels a step of a pixel crosses, the longest way.
PROBE_CLONES void place_run(const SeenFace& face, std::size_t first, std::size_t count,
                            const Arrays& a, const Steps& by, const TextureReads::Places& to) {
  const float* __restrict const across = a.across.data() + first;
  const float* __restrict const down = a.down.data() + first;
  const float* __restrict const denominators = a.denominator.data() + first;
  float* __restrict const out_u = to.u;
  float* __restrict const out_v = to.v;
  float* __restrict const out_texels = to.texels;
  const Steps steps = by;
  const float u_across = face.uv_by_across[0], u_down = face.uv_by_down[0],
              u_middle = face.uv_at_middle[0];
  const float v_across = face.uv_by_across[1], v_down = face.uv_by_down[1],
              v_middle = face.uv_at_middle[1];
  const float by_across = face.by_across[3], by_down = face.by_down[3], volume = face.volume;
  const auto larger = [](float x, float y) { return x < y ? y : x; };
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float inverse = 1 / denominators[i];
    const float scale = denominators[i] * volume > 0 ? inverse : 0;
    const float u = (u_across * across[i] + u_down * down[i] + u_middle) * scale;
    const float v = (v_across * across[i] + v_down * down[i] + v_middle) * scale;
    const float wide = steps.width * std::abs(scale), tall = steps.height * std::abs(scale);
    out_u[i] = u;
    out_v[i] = v;
    out_texels[i] = larger(larger(std::abs(u_across - u * by_across) * steps.right * wide,
                                  std::abs(u_down - u * by_down) * steps.below * wide),
                           larger(std::abs(v_across - v * by_across) * steps.right * tall,
                                  std::abs(v_down - v * by_down) * steps.below * tall));
  }
}

PROBE_CLONES void multiply(float* __restrict color, const float* __restrict by, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) color[i] *= by[i];
}

PROBE_CLONES void to_bytes(const float* __restrict color, std::size_t count,
                           std::uint8_t* __restrict bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    const float kept = 255.0f < color[i] ? 255.0f : color[i];
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::int32_t>(kept + 0.5f));
  }
}

// Bytes and depths of pixels that follow each other in a row, one triangle in each; whether all of
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

}  // namespace

void SeenRows::add(std::uint32_t face, std::uint16_t x, std::uint16_t y, std::size_t count,
                   const float* across, float down) {
  rows_.push_back(
      {face, static_cast<std::uint32_t>(count_), static_cast<std::uint32_t>(count), x, y});
  std::copy_n(across, count, arrays_->across.data() + count_);
  std::fill_n(arrays_->down.data() + count_, count, down);
  count_ += count;
}

void SeenRows::light_run(const SeenFace& face, std::size_t first, std::size_t count,
                         const PixelStep& step) {
  Arrays& a = *arrays_;
  show_run(face, first, count, a);
  if (face.texture == nullptr) {
    for (auto& texture : a.texture) std::fill_n(texture.data() + first, count, 255.0f);
    return;
  }
  const Steps steps{step.across, step.down, static_cast<float>(face.texture->width()),
                    static_cast<float>(face.texture->height())};
  place_run(face, first, count, a, steps, reads_.add(face.texture, first, count));
}

void SeenRows::light(const SeenFaces& faces, const PixelStep& step) {
  // Rows of a triangle below each other are one run.
  for (std::size_t i = 0; i < rows_.size();) {
    const std::size_t begin = i;
    while (i < rows_.size() && rows_[i].face == rows_[begin].face) ++i;
    const std::size_t first = rows_[begin].first, end = rows_[i - 1].first + rows_[i - 1].count;
    light_run(faces[rows_[begin].face], first, end - first, step);
  }
  reads_.read([this](std::size_t first, std::size_t count, const float* red, const float* green,
                     const float* blue) {
    std::copy_n(red, count, arrays_->texture[0].data() + first);
    std::copy_n(green, count, arrays_->texture[1].data() + first);
    std::copy_n(blue, count, arrays_->texture[2].data() + first);
  });
  for (std::size_t k = 0; k < 3; ++k)
    multiply(arrays_->color[k].data(), arrays_->texture[k].data(), count_);
}

void SeenRows::add_light(const Row& row, std::size_t pixel, const std::uint8_t* rgb) {
  for (std::size_t k = 0; k < 3; ++k)
    arrays_->color[k][row.first + pixel] += static_cast<float>(rgb[k]);
}

void SeenRows::write(const SeenFaces& faces, const SampleBuffer& samples, Picture& picture) {
  Arrays& a = *arrays_;
  for (std::size_t k = 0; k < 3; ++k) to_bytes(a.color[k].data(), count_, a.byte[k].data());
  for (const Row& row : rows_) {
    const std::size_t at = picture.at(row.x, row.y), first = row.first, count = row.count;
    const bool are_depths = write_run(a.byte[0].data() + first, a.byte[1].data() + first,
                                      a.byte[2].data() + first, a.depth.data() + first, count,
                                      picture.rgb.data() + 3 * at, picture.depth.data() + at);
    std::fill_n(picture.segmentation.data() + at, count, faces[row.face].body);
    if (are_depths) continue;
    for (std::size_t i = 0; i < count; ++i)
      picture.depth[at + i] = shown_depth(a.depth[first + i], faces[row.face],
                                          *samples.nearness(row.x + static_cast<int>(i), row.y));
  }
}

}  // namespace probe::render
