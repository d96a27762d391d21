#include "runtime/render/vertex_layer.h"

#include <algorithm>
#include <cmath>

namespace probe::render {
namespace {

// In the middle of a pixel, by what a triangle has by across, by down and in the middle.
inline Rgb plane(const Rgb& by_across, const Rgb& by_down, const Rgb& at_middle, float across,
                 float down) {
  return by_across * across + by_down * down + at_middle;
}

bool is_inside(const SeenFace& face, float across, float down) {
  return std::ranges::all_of(face.edge, [&](const Rgb& edge) {
    return (edge[0] * across + edge[1] * down + edge[2]) * face.volume >= 0;
  });
}

}  // namespace

void VertexLayer::find_faces(std::span<const PixelAt> pixels) {
  faces_.begin(meshes_);
  std::uint32_t last = 0;
  for (const PixelAt pixel : pixels) {
    const std::uint32_t* ids = buffer_.ids(pixel.x, pixel.y);
    for (int k = 0; k < 4; ++k) {
      if (ids[k] == last || ids[k] == 0) continue;
      last = ids[k];
      faces_.ask(last);
    }
  }
  faces_.find(meshes_);
}

void VertexLayer::show(std::span<const PixelAt> pixels, VertexLayer* mirrored, Picture& picture) {
  if (mirrored != nullptr) {
    mirrored->reflected_.clear(picture.width, picture.height);
    mirrored->show(pixels, nullptr, mirrored->reflected_);
  }
  // So many that what is found of their triangles stays near the processor.
  constexpr std::size_t kTogether = 256;
  for (std::size_t first = 0; first < pixels.size(); first += kTogether)
    show_some(pixels.subspan(first, std::min(kTogether, pixels.size() - first)), mirrored, picture);
}

void VertexLayer::show_some(std::span<const PixelAt> pixels, VertexLayer* mirrored,
                            Picture& picture) {
  find_faces(pixels);
  fragments_.clear();
  ends_.clear();
  for (Textured& textured : textured_) {
    textured.fragment.clear();
    for (auto* places : {&textured.u, &textured.v, &textured.texels}) places->clear();
  }
  const auto add = [this](std::uint32_t id, int samples, PixelAt at) {
    if (id == 0) {
      fragments_.push_back({Rgb{}, nullptr, 0, samples});
    } else {
      add_fragment(faces_.at(id), samples, at);
    }
  };
  for (const PixelAt pixel : pixels) {
    const std::uint32_t* ids = buffer_.ids(pixel.x, pixel.y);
    if (ids[0] == ids[1] && ids[0] == ids[2] && ids[0] == ids[3]) {
      add(ids[0], 4, pixel);
    } else {
      for (int i = 0; i < 4; ++i) {
        if (std::find(ids, ids + i, ids[i]) != ids + i) continue;
        add(ids[i], static_cast<int>(std::count(ids + i, ids + 4, ids[i])), pixel);
      }
    }
    ends_.push_back(static_cast<std::uint32_t>(fragments_.size()));
  }
  read_textures();
  std::size_t first = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::span<const Fragment> pixel = std::span(fragments_).subspan(first, ends_[i] - first);
    first = ends_[i];
    const std::size_t at = picture.at(pixels[i].x, pixels[i].y);
    using Sums = std::int32_t __attribute__((vector_size(16)));
    Sums sum{};
    for (const Fragment& fragment : pixel) {
      if (fragment.face == nullptr) continue;
      Rgb color = fragment.color;
      if (mirrored != nullptr && fragment.face->mirror > 0) {
        const std::uint8_t* seen = &mirrored->reflected_.rgb[3 * at];
        color += Rgb{static_cast<float>(seen[0]), static_cast<float>(seen[1]),
                     static_cast<float>(seen[2]), 0};
      }
      constexpr Rgb kFull{255, 255, 255, 255};
      color = kFull < color ? kFull : color;
      sum += fragment.samples * __builtin_convertvector(color + 0.5f, Sums);
    }
    for (int k = 0; k < 3; ++k)
      picture.rgb[3 * at + static_cast<std::size_t>(k)] =
          static_cast<std::uint8_t>((sum[k] + 2) / 4);
    const Fragment& middle = middle_of(pixel, pixels[i]);
    if (middle.face == nullptr) {
      picture.depth[at] = 0;
      picture.segmentation[at] = 0;
      continue;
    }
    const float depth = middle.face->volume / middle.denominator;
    picture.depth[at] =
        depth > 0 && std::isfinite(depth) ? depth : 1 / *buffer_.nearness(pixels[i].x, pixels[i].y);
    picture.segmentation[at] = middle.face->body;
  }
}

// What a triangle shows in the middle of a pixel, whether that lies in it or beside.
void VertexLayer::add_fragment(const SeenFace& face, int samples, PixelAt at) {
  const float across = meshes_.across(at.x), down = meshes_.down(at.y);
  const Rgb sums = plane(face.by_across, face.by_down, face.at_middle, across, down);
  const float denominator = sums[3];
  const bool is_before = denominator * face.volume > 0;
  Rgb color = is_before ? sums / denominator : face.mean;
  constexpr Rgb kNone{}, kFull{1, 1, 1, 1};
  color = color > kNone ? (color < kFull ? color : kFull) : kNone;
  if (face.texture == nullptr) {
    fragments_.push_back({color * 255.0f, &face, denominator, samples});
    return;
  }
  fragments_.push_back({color, &face, denominator, samples});
  const float scale = is_before ? 1 / denominator : 0;
  const Rgb uv = plane(face.uv_by_across, face.uv_by_down, face.uv_at_middle, across, down) * scale;
  // How far a step of a pixel goes in the texture, the longest way.
  const auto wide = static_cast<float>(face.texture->width()) * std::abs(scale);
  const auto tall = static_cast<float>(face.texture->height()) * std::abs(scale);
  const float right = meshes_.step_across(), below = meshes_.step_down();
  const Rgb by_across = face.uv_by_across - uv * face.by_across[3];
  const Rgb by_down = face.uv_by_down - uv * face.by_down[3];
  const float texels = std::max(
      std::max(std::abs(by_across[0]) * right * wide, std::abs(by_down[0]) * below * wide),
      std::max(std::abs(by_across[1]) * right * tall, std::abs(by_down[1]) * below * tall));
  if (last_textured_ >= textured_.size() || textured_[last_textured_].texture != face.texture) {
    auto of = std::ranges::find(textured_, face.texture, &Textured::texture);
    if (of == textured_.end()) of = textured_.insert(of, Textured{face.texture, {}, {}, {}, {}});
    last_textured_ = static_cast<std::size_t>(of - textured_.begin());
  }
  Textured& of = textured_[last_textured_];
  of.fragment.push_back(static_cast<std::uint32_t>(fragments_.size() - 1));
  of.u.push_back(uv[0]);
  of.v.push_back(uv[1]);
  of.texels.push_back(texels);
}

void VertexLayer::read_textures() {
  for (const Textured& of : textured_) {
    const std::size_t count = of.fragment.size();
    if (count == 0) continue;
    texels_.resize(std::max(texels_.size(), 3 * count));
    float* const red = texels_.data();
    of.texture->read(of.u, of.v, of.texels, {red, red + count, red + 2 * count});
    for (std::size_t i = 0; i < count; ++i)
      fragments_[of.fragment[i]].color *= Rgb{red[i], red[count + i], red[2 * count + i], 0};
  }
}

// The triangle in the middle of a pixel: of the body that has most of its samples, and else of any,
// the nearest that holds it, else the one of most samples. A body of many small triangles may have
// none in a sample that holds the middle, while a table behind it has one in all.
const VertexLayer::Fragment& VertexLayer::middle_of(std::span<const Fragment> pixel,
                                                    PixelAt at) const {
  if (pixel.size() == 1) return pixel[0];
  const float across = meshes_.across(at.x), down = meshes_.down(at.y);
  const Fragment* inside = nullptr;
  const Fragment* most = &pixel[0];
  float nearest = 0;
  const auto body_of = [](const Fragment& fragment) {
    return fragment.face == nullptr ? 0 : int{fragment.face->body};
  };
  const auto samples_of = [&](int body) {
    int samples = 0;
    for (const Fragment& fragment : pixel) samples += body_of(fragment) == body ? fragment.samples : 0;
    return samples;
  };
  constexpr int kMost = 3, kAny = -1;  // of four samples
  int wanted = kAny;
  for (const Fragment& fragment : pixel) {
    if (samples_of(body_of(fragment)) >= kMost) wanted = body_of(fragment);
  }
  for (const Fragment& fragment : pixel) {
    if (wanted != kAny && body_of(fragment) != wanted) continue;
    if (wanted != kAny && body_of(*most) != wanted) most = &fragment;
    if (fragment.samples > most->samples) most = &fragment;
    if (fragment.face == nullptr || !is_inside(*fragment.face, across, down)) continue;
    const float nearness = fragment.denominator / fragment.face->volume;
    if (nearness > nearest) {
      nearest = nearness;
      inside = &fragment;
    }
  }
  return inside != nullptr ? *inside : *most;
}

}  // namespace probe::render
