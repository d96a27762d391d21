#include "runtime/servers/jpeg_round_trip.h"

#include <cstddef>
#include <cstdio>  // jpeglib.h needs it before
#include <cstdlib>
#include <memory>

#include <jpeglib.h>

#include "runtime/base/check.h"

namespace probe::servers {
namespace {

constexpr int kQuality = 95;  // tf.image.encode_jpeg's default
constexpr int kChannels = 3;

struct FreeMemory {
  void operator()(unsigned char* bytes) const { std::free(bytes); }
};
struct File {
  std::unique_ptr<unsigned char, FreeMemory> bytes;
  unsigned long size = 0;
};

// The library's way to fail is to leave the process: what fails here is this code.
void fail(j_common_ptr about) {
  char text[JMSG_LENGTH_MAX];
  about->err->format_message(about, text);
  PROBE_CHECK(false, text);
}

File encode(const policy::Image& image) {
  jpeg_error_mgr errors;
  jpeg_compress_struct jpeg;
  jpeg.err = jpeg_std_error(&errors);
  errors.error_exit = fail;
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  File file;
  jpeg_mem_dest(&jpeg, &bytes, &file.size);
  jpeg.image_width = static_cast<JDIMENSION>(image.width);
  jpeg.image_height = static_cast<JDIMENSION>(image.height);
  jpeg.input_components = kChannels;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, kQuality, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < jpeg.image_height) {
    const std::size_t at = std::size_t{jpeg.next_scanline} * jpeg.image_width * kChannels;
    JSAMPROW row = const_cast<JSAMPROW>(&image.rgb[at]);  // read only
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  file.bytes.reset(bytes);
  return file;
}

wire::Bytes decode(const File& file) {
  jpeg_error_mgr errors;
  jpeg_decompress_struct jpeg;
  jpeg.err = jpeg_std_error(&errors);
  errors.error_exit = fail;
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, file.bytes.get(), file.size);
  jpeg_read_header(&jpeg, TRUE);
  jpeg.dct_method = JDCT_IFAST;  // tf.io.decode_image's default; encoding's is the accurate one
  jpeg_start_decompress(&jpeg);
  const std::size_t row_bytes = std::size_t{jpeg.output_width} * kChannels;
  wire::Bytes rgb(row_bytes * jpeg.output_height);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = rgb.data() + row_bytes * jpeg.output_scanline;
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  jpeg_destroy_decompress(&jpeg);
  return rgb;
}

}  // namespace

wire::Bytes through_jpeg(const policy::Image& image) { return decode(encode(image)); }

}  // namespace probe::servers
