#include "runtime/render/mixed_pixels.h"

#include <cmath>
#include <cstring>

#include "runtime/render/extremes.h"

namespace probe::render {
namespace {

using Ints = std::int32_t __attribute__((vector_size(16)));

// What is linear in the picture, at one place of it.
inline Rgb plane(const Rgb& by_across, const Rgb& by_down, const Rgb& at_middle, float across,
                 float down) {
  return by_across * across + by_down * down + at_middle;
}

// What a triangle shows in the middle of a pixel, 0 .. 1, whether that lies in it or beside; the
// denominator is found on the way.
inline Rgb color_of(const SeenFace& face, float across, float down, float& denominator) {
  const Rgb sums = plane(face.by_across, face.by_down, face.at_middle, across, down);
  denominator = sums[3];
  const bool is_before = denominator * face.volume > 0;
  const Rgb color = is_before ? sums / denominator : face.mean;
  constexpr Rgb kNone{}, kFull{1, 1, 1, 1};
  return color > kNone ? (color < kFull ? color : kFull) : kNone;
}

// Where its texture is read there, and how many texels a step of a pixel crosses, the longest way.
inline void place(const SeenFace& face, float across, float down, float denominator,
                  const PixelStep& step, const TextureReads::Places& to) {
  const bool is_before = denominator * face.volume > 0;
  const float scale = is_before ? 1 / denominator : 0;
  const Rgb uv = plane(face.uv_by_across, face.uv_by_down, face.uv_at_middle, across, down) * scale;
  const float wide = static_cast<float>(face.texture->width()) * std::abs(scale),
              tall = static_cast<float>(face.texture->height()) * std::abs(scale);
  const Rgb by_across = face.uv_by_across - uv * face.by_across[3];
  const Rgb by_down = face.uv_by_down - uv * face.by_down[3];
  *to.u = uv[0];
  *to.v = uv[1];
  *to.texels = std::max(std::max(std::abs(by_across[0]) * step.across * wide,
                                 std::abs(by_down[0]) * step.down * wide),
                        std::max(std::abs(by_across[1]) * step.across * tall,
                                 std::abs(by_down[1]) * step.down * tall));
}

// The ray's point in the triangle's plane lies in the triangle.
inline bool is_inside(const SeenFace& face, float across, float down) {
  const Rgb edges =
      plane(face.edge_by_across, face.edge_by_down, face.edge_at_middle, across, down) *
      face.volume;
  const Ints inside = edges >= 0;
  std::int32_t four[4];
  std::memcpy(four, &inside, sizeof inside);
  return (signs_of(four) & 7u) == 7u;
}

}  // namespace

void MixedPixels::add(std::uint16_t x, std::uint16_t y, float across, float down,
                      const std::uint32_t* ids, SeenFaces& faces) {
  // Each triangle once, where it is met first. All are written, and what is no new one is written
  // over: whether it is one cannot be foreseen.
  const std::uint32_t a = ids[0], b = ids[1], c = ids[2], d = ids[3];
  const std::int32_t ab = is(a == b), ac = is(a == c), ad = is(a == d), bc = is(b == c),
                     bd = is(b == d), cd = is(c == d);
  Fragment* to = arrays_->fragment.data() + fragments_;
  *to = {faces.ask(a), 1 + ab + ac + ad};
  to += 1;
  *to = {faces.ask(b), 1 + bc + bd};
  to += 1 - ab;
  *to = {faces.ask(c), 1 + cd};
  to += 1 - (ac | bc);
  *to = {faces.ask(d), 1};
  to += 1 - (ad | bd | cd);
  fragments_ = static_cast<std::size_t>(to - arrays_->fragment.data());
  arrays_->pixel[pixels_++] = {across, down, x, y, static_cast<std::uint32_t>(fragments_)};
}

void MixedPixels::light(const SeenFaces& faces, const PixelStep& step) {
  Arrays& a = *arrays_;
  std::size_t f = 0;
  for (std::size_t i = 0; i < pixels_; ++i) {
    const Pixel pixel = a.pixel[i];
    for (; f < pixel.end; ++f) {
      const SeenFace& face = faces[a.fragment[f].face];
      float denominator = 0;
      const Rgb color = color_of(face, pixel.across, pixel.down, denominator);
      a.denominator[f] = denominator;
      a.color[f] = face.texture == nullptr ? color * 255.0f : color;
      if (face.texture != nullptr)
        place(face, pixel.across, pixel.down, denominator, step, reads_.add(face.texture, f, 1));
    }
  }
  reads_.read([&a](std::size_t first, std::size_t count, const float* red, const float* green,
                   const float* blue) {
    for (std::size_t i = 0; i < count; ++i) a.color[first + i] *= Rgb{red[i], green[i], blue[i], 0};
  });
}

void MixedPixels::write(const SeenFaces& faces, const SampleBuffer& samples,
                        Picture& picture) const {
  const Arrays& a = *arrays_;
  std::uint8_t* const colors = picture.rgb.data();
  float* const depths = picture.depth.data();
  std::uint16_t* const bodies = picture.segmentation.data();
  const auto width = static_cast<std::size_t>(picture.width);
  std::size_t first = 0;
  for (std::size_t i = 0; i < pixels_; ++i) {
    const Pixel& pixel = a.pixel[i];
    // The mean of samples' bytes, halves up.
    Ints sum = Ints{} + 2;
    for (std::size_t f = first; f < pixel.end; ++f) {
      const Rgb color = 255.0f < a.color[f] ? Rgb{} + 255.0f : a.color[f];
      sum += __builtin_convertvector(color + 0.5f, Ints) * a.fragment[f].samples;
    }
    sum >>= 2;
    const std::size_t at = std::size_t{pixel.y} * width + pixel.x;
    for (int k = 0; k < 3; ++k)
      colors[3 * at + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(sum[k]);
    const std::size_t middle = pixel.end - first == 1 ? first : middle_of(faces, pixel, first);
    const SeenFace& face = faces[a.fragment[middle].face];
    bodies[at] = face.body;
    depths[at] =
        shown_depth(face.volume / a.denominator[middle], face, *samples.nearness(pixel.x, pixel.y));
    first = pixel.end;
  }
}

// The triangle in the middle of a pixel: of the body that has most of its samples, and else of any,
// the nearest that holds it, else the one of most samples. A body of many small triangles may have
// none in a sample that holds the middle, while a table behind it has one in all.
std::size_t MixedPixels::middle_of(const SeenFaces& faces, const Pixel& pixel,
                                   std::size_t first) const {
  const Arrays& a = *arrays_;
  const std::size_t count = pixel.end - first;
  std::array<const SeenFace*, 4> shown;
  std::array<std::int32_t, 4> parts;
  bool is_one_body = true;
  for (std::size_t f = 0; f < count; ++f) {
    shown[f] = &faces[a.fragment[first + f].face];
    parts[f] = a.fragment[first + f].samples;
    is_one_body &= shown[f]->body == shown[0]->body;
  }
  // Which of them count: those of the body that has most; where none has, all.
  std::array<bool, 4> counts{true, true, true, true};
  constexpr std::int32_t kMostSamples = 3;
  for (std::size_t f = 0; f < count && !is_one_body; ++f) {
    std::int32_t of_body = 0;
    for (std::size_t g = 0; g < count; ++g)
      of_body += shown[g]->body == shown[f]->body ? parts[g] : 0;
    if (of_body < kMostSamples) continue;
    for (std::size_t g = 0; g < count; ++g) counts[g] = shown[g]->body == shown[f]->body;
    break;
  }
  std::size_t inside = count, most = 0;
  std::int32_t most_samples = 0;
  float nearest = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const bool is_counted = counts[f], has_more = parts[f] > most_samples;
    const bool is_more = is_counted & has_more;
    most = is_more ? f : most;
    most_samples = is_more ? parts[f] : most_samples;
    const float nearness = a.denominator[first + f] / shown[f]->volume;
    const bool holds = is_inside(*shown[f], pixel.across, pixel.down),
               is_something = shown[f]->id != 0, is_before = nearness > nearest;
    const bool is_nearer = is_counted & is_something & is_before & holds;
    inside = is_nearer ? f : inside;
    nearest = is_nearer ? nearness : nearest;
  }
  return first + (inside != count ? inside : most);
}

}  // namespace probe::render
