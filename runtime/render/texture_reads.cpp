#include "runtime/render/texture_reads.h"

namespace probe::render {

TextureReads::OfTexture& TextureReads::of(const MipChain* texture) {
  if (last_ >= textures_.size() || textures_[last_].texture != texture) {
    auto at = std::ranges::find(textures_, texture, &OfTexture::texture);
    if (at == textures_.end()) at = textures_.insert(at, OfTexture{texture, {}, {}, {}, {}, 0});
    last_ = static_cast<std::size_t>(at - textures_.begin());
  }
  return textures_[last_];
}

TextureReads::Places TextureReads::add(const MipChain* texture, std::size_t first,
                                       std::size_t count) {
  OfTexture& to = of(texture);
  const std::size_t at = to.count;
  to.count += count;
  if (to.u.size() < to.count) {
    for (auto* places : {&to.u, &to.v, &to.texels}) places->resize(2 * to.count);
  }
  to.runs.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
  return {to.u.data() + at, to.v.data() + at, to.texels.data() + at};
}

void TextureReads::read_texture(const OfTexture& of) {
  const auto whole = [&of](const std::vector<float>& places) {
    return std::span(places).first(of.count);
  };
  float* const red = colors_.data();
  of.texture->read(whole(of.u), whole(of.v), whole(of.texels),
                   {red, red + of.count, red + 2 * of.count});
}

}  // namespace probe::render
