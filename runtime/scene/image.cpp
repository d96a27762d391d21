#include "runtime/scene/image.h"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include "runtime/base/file.h"
#include "runtime/base/io_failure.h"
#include "runtime/base/large.h"

namespace probe::scene {
namespace {

Failure asset_failure(std::string message, const std::string& where) {
  return {.code = Fault::kAsset, .message = std::move(message), .where = where};
}

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// 8 bits a channel.
struct PngFormat {
  int color_type;
  std::size_t bytes_per_pixel;
  PngEffort effort = PngEffort::kQuick;
};
constexpr PngFormat kRgb{PNG_COLOR_TYPE_RGB, 3};

// libpng would print; our callers get a Failure instead.
[[noreturn]] void on_png_error(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void on_png_warning(png_structp, png_const_charp) {}

// libpng leaves by longjmp; nothing with a destructor lives in this frame. Returns false on any
// error.
bool encode_png(std::FILE* file, int width, int height, const PngFormat& format,
                const std::uint8_t* pixels) {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, on_png_error, on_png_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               format.color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  // libpng tries all filters on every row unless it is told one.
  const bool one_filter = format.effort != PngEffort::kQuick;
  png_set_compression_level(png, format.effort == PngEffort::kSmallest  ? 9
                                 : format.effort == PngEffort::kFastest ? 1
                                                                        : 4);
  if (one_filter) png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_write_info(png, info);
  const std::size_t stride = static_cast<std::size_t>(width) * format.bytes_per_pixel;
  for (int row = 0; row < height; ++row) {
    png_write_row(png, pixels + static_cast<std::size_t>(row) * stride);
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

Status check_size(int width, int height, std::size_t bytes_per_pixel, std::size_t bytes,
                  const std::string& where) {
  const std::size_t expected = static_cast<std::size_t>(width > 0 ? width : 0) *
                               static_cast<std::size_t>(height > 0 ? height : 0) * bytes_per_pixel;
  if (expected != 0 && bytes == expected) return {};
  return Failure{.code = Fault::kIo,
                 .message = "a picture of " + std::to_string(width) + " x " +
                            std::to_string(height) + " needs " + std::to_string(expected) +
                            " bytes, got " + std::to_string(bytes),
                 .where = where};
}

Result<std::string> png_in_memory(int width, int height, const PngFormat& format,
                                  const std::uint8_t* pixels) {
  char* data = nullptr;
  std::size_t size = 0;
  std::unique_ptr<std::FILE, FileCloser> file(open_memstream(&data, &size));
  bool fine = file && encode_png(file.get(), width, height, format, pixels);
  if (file) fine = std::fclose(file.release()) == 0 && fine;
  const std::unique_ptr<char, void (*)(void*)> owned(data, std::free);
  if (!fine) return Failure{Fault::kIo, "no memory to write a picture", ""};
  return std::string(data, size);
}

}  // namespace

Result<ImageSize> image_size(std::span<const std::byte> encoded, const std::string& where) {
  if (encoded.empty()) return asset_failure("the image is empty", where);
  if (encoded.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return asset_failure("the image file is larger than 2 GB", where);
  }
  ImageSize size;
  int channels = 0;
  if (stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(encoded.data()),
                            static_cast<int>(encoded.size()), &size.width, &size.height,
                            &channels) == 0) {
    return asset_failure(std::string("cannot read the image (") + stbi_failure_reason() + ")",
                         where);
  }
  const int most = allowed(kMaxImageSide);
  if (size.width > most || size.height > most) {
    return asset_failure("the image has " + std::to_string(size.width) + " x " +
                             std::to_string(size.height) + " pixels, at most " +
                             std::to_string(most) + " a side are read" + large_hint(),
                         where);
  }
  return size;
}

Result<Texture> decode_image(std::span<const std::byte> encoded, const std::string& where) {
  PROBE_TRY(image_size(encoded, where));
  const auto* bytes = reinterpret_cast<const stbi_uc*>(encoded.data());
  const int size = static_cast<int>(encoded.size());
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes, size, &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) {
    const char* const why = stbi_failure_reason();
    const bool says_why = why != nullptr && *why != '\0';
    return asset_failure("cannot decode the image (" +
                             std::string(says_why ? why : "it is damaged or cut off") + ")",
                         where);
  }
  Texture texture{.width = width, .height = height, .rgba = {}};
  texture.rgba.assign(pixels.get(), pixels.get() + 4 * static_cast<std::size_t>(width) *
                                                       static_cast<std::size_t>(height));
  return texture;
}

Result<Texture> load_image(const std::string& path) {
  PROBE_ASSIGN(const std::string bytes, read_file(path, {.code = Fault::kAsset}));
  return decode_image(std::as_bytes(std::span(bytes)), path);
}

Result<std::string> png_bytes(const Texture& texture) {
  return png_in_memory(texture.width, texture.height, {PNG_COLOR_TYPE_RGB_ALPHA, 4},
                       texture.rgba.data());
}

Result<std::string> png_bytes(int width, int height, std::span<const std::uint8_t> rgb,
                              PngEffort effort) {
  PROBE_TRY(check_size(width, height, 3, rgb.size(), ""));
  PngFormat format = kRgb;
  format.effort = effort;
  return png_in_memory(width, height, format, rgb.data());
}

Result<std::string> jpeg_bytes(int width, int height, std::span<const std::uint8_t> rgb,
                               int quality) {
  PROBE_TRY(check_size(width, height, 3, rgb.size(), ""));
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data),
                                          static_cast<std::size_t>(size));
  };
  if (stbi_write_jpg_to_func(append, &bytes, width, height, 3, rgb.data(), quality) == 0) {
    return Failure{Fault::kIo, "a picture cannot be written as JPEG", ""};
  }
  return bytes;
}

Status write_png(const std::string& path, int width, int height,
                 std::span<const std::uint8_t> rgb) {
  PROBE_TRY(check_size(width, height, 3, rgb.size(), path));
  PendingFile pending(path);
  std::unique_ptr<std::FILE, FileCloser> file(std::fopen(pending.temporary().c_str(), "wb"));
  if (!file) return io_failure("cannot create the file", path);
  errno = 0;
  // libpng hides short writes of stdio's buffer; flush and close tell of a full disk.
  bool fine = encode_png(file.get(), width, height, kRgb, rgb.data());
  fine = fine && std::fflush(file.get()) == 0;
  fine = (std::fclose(file.release()) == 0) && fine;
  if (!fine) return io_failure("cannot write the picture", path);
  return pending.keep();
}

}  // namespace probe::scene
