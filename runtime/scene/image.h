// Image files: PNG, JPEG and the like in, PNG out. Knows nothing of meshes or cameras.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "runtime/base/result.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

// Larger images are refused: more texels than any picture of ours can show, and a header can
// promise anything.
inline constexpr int kMaxImageSide = 16384;

// Fails (code "asset", where = path) on a missing file, a format that cannot be read, damage, or a
// side above the limit.
Result<Texture> load_image(const std::string& path);
// The same for an encoded image in memory; `where` is for messages.
Result<Texture> decode_image(std::span<const std::byte> encoded, const std::string& where);

// Writes beside the target and renames, so that the file is whole or absent; a full disk is a
// Failure (code "io"). Rows from the top. `rgb` has 3 bytes a pixel, `gray` 1 byte or 1 16-bit
// number a pixel.
Status write_png(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb);
Status write_png_gray(const std::string& path, int width, int height,
                      std::span<const std::uint8_t> gray);
Status write_png_gray16(const std::string& path, int width, int height,
                        std::span<const std::uint16_t> gray);

}  // namespace probe::scene
