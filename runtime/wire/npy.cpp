#include "runtime/wire/npy.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

namespace probe::wire {
namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kAlignment = 64;  // of the data, from numpy 1.14 on

Failure bad_npy(const std::string& message) {
  return {Fault::kPolicy, "a .npy array " + message, ""};
}

std::string shape_text(const std::vector<std::int64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

// What stands after 'key': in the header's dictionary, up to its own end.
std::string_view after_key(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  std::string_view rest = header.substr(at + key.size());
  const std::size_t first = rest.find_first_not_of(": ");
  return first == std::string_view::npos ? std::string_view() : rest.substr(first);
}

// As it is written, whatever its dtype.
Result<Array> read_npy(const Bytes& file) {
  if (file.size() < 10 || std::memcmp(file.data(), kMagic.data(), kMagic.size()) != 0) {
    return bad_npy("does not begin with numpy's mark");
  }
  // Versions 2 and 3 have a 4-byte length.
  const bool is_long = file[6] >= 2;
  const std::size_t first = is_long ? 12 : 10;
  if (file.size() < first) return bad_npy("ends in its header");
  std::size_t length = 0;
  for (std::size_t i = first; i-- > 8;) length = length << 8 | file[i];
  if (length > file.size() - first) return bad_npy("ends in its header");
  const std::string_view header(reinterpret_cast<const char*>(file.data()) + first, length);

  Array array;
  const std::string_view descr = after_key(header, "'descr'");
  if (descr.size() < 2 || descr[0] != '\'') return bad_npy("has no dtype");
  array.dtype = std::string(descr.substr(1, descr.find('\'', 1) - 1));
  if (!after_key(header, "'fortran_order'").starts_with("False"))
    return bad_npy("is not in C order");
  std::string_view shape = after_key(header, "'shape'");
  if (!shape.starts_with("(") || shape.find(')') == std::string_view::npos)
    return bad_npy("has no shape");
  shape = shape.substr(1, shape.find(')') - 1);
  while (!shape.empty()) {
    std::int64_t n = 0;
    const auto [end, error] = std::from_chars(shape.data(), shape.data() + shape.size(), n);
    if (error != std::errc()) return bad_npy("has a shape that is not made of sizes");
    if (array.shape.size() == kMostDimensions) return bad_npy("has a shape of too many sizes");
    array.shape.push_back(n);
    shape.remove_prefix(static_cast<std::size_t>(end - shape.data()));
    const std::size_t next = shape.find_first_not_of(", ");
    shape = next == std::string_view::npos ? std::string_view() : shape.substr(next);
  }
  array.bytes.assign(file.begin() + static_cast<std::ptrdiff_t>(first + length), file.end());
  return array;
}

}  // namespace

Bytes to_npy(const Array& array) {
  std::string header = "{'descr': '" + array.dtype +
                       "', 'fortran_order': False, 'shape': " + shape_text(array.shape) + ", }";
  const std::size_t before = kMagic.size() + 2 + 2;
  const std::size_t total = (before + header.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  header.append(total - before - header.size() - 1, ' ');
  header += '\n';
  std::string text(kMagic);
  text += {1, 0, static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
  text += header;
  Bytes file(text.size() + array.bytes.size());
  std::copy(text.begin(), text.end(), file.begin());
  std::copy(array.bytes.begin(), array.bytes.end(),
            file.begin() + static_cast<std::ptrdiff_t>(text.size()));
  return file;
}

Result<Array> from_npy(const Bytes& file) {
  PROBE_ASSIGN(Array array, read_npy(file));
  PROBE_TRY(check_fit(array));
  return array;
}

Result<std::vector<std::string>> texts_from_npy(const Bytes& file) {
  constexpr std::size_t kPoint = 4;  // bytes, little-endian
  PROBE_ASSIGN(const Array array, read_npy(file));
  std::size_t width = 0;
  const std::string_view dtype = array.dtype;
  const char* const end = dtype.data() + dtype.size();
  if (!dtype.starts_with("<U") || array.shape.size() != 1 ||
      std::from_chars(dtype.data() + 2, end, width).ptr != end)
    return bad_npy("is no row of texts");
  const auto count = static_cast<std::size_t>(array.shape[0]);
  if (array.shape[0] < 0 || width == 0 || array.bytes.size() % (kPoint * width) != 0 ||
      array.bytes.size() / (kPoint * width) != count)
    return bad_npy("has another size than its shape says");
  std::vector<std::string> texts(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      const std::uint8_t* const point = &array.bytes[kPoint * (i * width + k)];
      if (std::all_of(point, point + kPoint, [](std::uint8_t byte) { return byte == 0; })) break;
      if (point[0] > 127 || point[1] != 0 || point[2] != 0 || point[3] != 0)
        return bad_npy("has a letter that is not ASCII");
      texts[i] += static_cast<char>(point[0]);
    }
  }
  return texts;
}

}  // namespace probe::wire
