#include "runtime/render/seen_fragments.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
namespace {

using Arrays = SeenFragments::Arrays;

// From here on, what one triangle shows in pixels that follow each other is found as arrays.
constexpr std::size_t kArrayRun = 6;

// In the middle of a pixel, by what a triangle has by across, by down and in the middle.
inline Rgb plane(const Rgb& by_across, const Rgb& by_down, const Rgb& at_middle, float across,
                 float down) {
  return by_across * across + by_down * down + at_middle;
}

// How far a step of a pixel goes, and how large a texture is.
struct Steps {
  float right, below, width, height;
};

struct TexturePlaces {
  float *u, *v, *texels;
};

// What a triangle shows in the middle of a pixel, whether that lies in it or beside.
inline void show_one(const SeenFace& face, std::size_t i, Arrays& a) {
  const Rgb sums = plane(face.by_across, face.by_down, face.at_middle, a.across[i], a.down[i]);
  const float denominator = sums[3];
  const bool is_before = denominator * face.volume > 0;
  Rgb color = is_before ? sums / denominator : face.mean;
  constexpr Rgb kNone{}, kFull{1, 1, 1, 1};
  color = color > kNone ? (color < kFull ? color : kFull) : kNone;
  for (std::size_t k = 0; k < 3; ++k) a.color[k][i] = color[k];
  a.denominator[i] = denominator;
  a.depth[i] = face.volume / denominator;
}

// Where its texture is read there, and how many texels a step of a pixel crosses, the longest way.
inline void place_one(const SeenFace& face, float across, float down, float denominator,
                      const Steps& steps, float& u, float& v, float& texels) {
  const bool is_before = denominator * face.volume > 0;
  const float scale = is_before ? 1 / denominator : 0;
  const Rgb uv = plane(face.uv_by_across, face.uv_by_down, face.uv_at_middle, across, down) * scale;
  const float wide = steps.width * std::abs(scale), tall = steps.height * std::abs(scale);
  const Rgb by_across = face.uv_by_across - uv * face.by_across[3];
  const Rgb by_down = face.uv_by_down - uv * face.by_down[3];
  u = uv[0];
  v = uv[1];
  texels = std::max(std::max(std::abs(by_across[0]) * steps.right * wide,
                             std::abs(by_down[0]) * steps.below * wide),
                    std::max(std::abs(by_across[1]) * steps.right * tall,
                             std::abs(by_down[1]) * steps.below * tall));
}

// The same, of many fragments.
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

PROBE_CLONES void place_run(const SeenFace& face, std::size_t first, std::size_t count,
                            const Arrays& a, const Steps& by, const TexturePlaces& to) {
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

}  // namespace

SeenFragments::Textured& SeenFragments::textured(const MipChain* texture) {
  if (last_textured_ >= textured_.size() || textured_[last_textured_].texture != texture) {
    auto of = std::ranges::find(textured_, texture, &Textured::texture);
    if (of == textured_.end()) {
      of = textured_.insert(of, Textured{texture, {}, {}, {}, {}, 0});
      for (auto* places : {&of->u, &of->v, &of->texels}) places->resize(kMost);
    }
    last_textured_ = static_cast<std::size_t>(of - textured_.begin());
  }
  return textured_[last_textured_];
}

void SeenFragments::light_run(const SeenFace& face, std::size_t first, std::size_t count,
                              float step_across, float step_down) {
  Arrays& a = *arrays_;
  const bool is_long = count >= kArrayRun;
  if (is_long) {
    show_run(face, first, count, a);
  } else {
    for (std::size_t i = first; i < first + count; ++i) show_one(face, i, a);
  }
  if (face.texture == nullptr) {
    for (auto& texture : a.texture) std::fill_n(texture.data() + first, count, 255.0f);
    return;
  }
  Textured& of = textured(face.texture);
  const Steps steps{step_across, step_down, static_cast<float>(face.texture->width()),
                    static_cast<float>(face.texture->height())};
  if (is_long) {
    place_run(face, first, count, a, steps,
              {of.u.data() + of.count, of.v.data() + of.count, of.texels.data() + of.count});
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t from = first + i, to = of.count + i;
      place_one(face, a.across[from], a.down[from], a.denominator[from], steps, of.u[to], of.v[to],
                of.texels[to]);
    }
  }
  of.runs.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
  of.count += count;
}

void SeenFragments::light(const SeenFaces& faces, float step_across, float step_down) {
  const auto& face = arrays_->face;
  for (std::size_t first = 0; first < count_;) {
    std::size_t end = first + 1;
    while (end < count_ && face[end] == face[first]) ++end;
    light_run(faces[face[first]], first, end - first, step_across, step_down);
    first = end;
  }
  read_textures();
  for (std::size_t k = 0; k < 3; ++k)
    multiply(arrays_->color[k].data(), arrays_->texture[k].data(), count_);
}

void SeenFragments::read_textures() {
  for (Textured& of : textured_) {
    const std::size_t count = of.count;
    if (count == 0) continue;
    texels_.resize(std::max(texels_.size(), 3 * count));
    float* const red = texels_.data();
    const auto whole = [count](const std::vector<float>& places) {
      return std::span(places).first(count);
    };
    of.texture->read(whole(of.u), whole(of.v), whole(of.texels),
                     {red, red + count, red + 2 * count});
    for (std::size_t k = 0; k < 3; ++k) {
      const float* from = red + k * count;
      float* const to = arrays_->texture[k].data();
      for (const Textured::Run& run : of.runs) {
        for (std::size_t i = 0; i < run.count; ++i) to[run.first + i] = from[i];
        from += run.count;
      }
    }
    of.runs.clear();
    of.count = 0;
  }
}

void SeenFragments::round() {
  for (std::size_t k = 0; k < 3; ++k)
    to_bytes(arrays_->color[k].data(), count_, arrays_->byte[k].data());
}

}  // namespace probe::render
