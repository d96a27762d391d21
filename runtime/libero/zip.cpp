#include "runtime/libero/zip.h"

#include <fmt/format.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "runtime/base/large.h"

namespace probe::libero {
namespace {

constexpr std::size_t kMostMembers = 4096;

// What minizip reads from, as it would from a file.
struct Source {
  std::span<const std::uint8_t> bytes;
  std::size_t at = 0;
};

voidpf open_source(voidpf opaque, const void*, int) { return opaque; }
uLong read_source(voidpf, voidpf stream, void* to, uLong size) {
  auto& source = *static_cast<Source*>(stream);
  const std::size_t count = std::min<std::size_t>(size, source.bytes.size() - source.at);
  if (count > 0) std::memcpy(to, source.bytes.data() + source.at, count);
  source.at += count;
  return static_cast<uLong>(count);
}
uLong write_source(voidpf, voidpf, const void*, uLong) { return 0; }
ZPOS64_T tell_source(voidpf, voidpf stream) { return static_cast<Source*>(stream)->at; }
long seek_source(voidpf, voidpf stream, ZPOS64_T offset, int origin) {
  auto& source = *static_cast<Source*>(stream);
  const std::size_t from = origin == ZLIB_FILEFUNC_SEEK_CUR   ? source.at
                           : origin == ZLIB_FILEFUNC_SEEK_END ? source.bytes.size()
                                                              : 0;
  if (offset > source.bytes.size() - from) return -1;
  source.at = from + static_cast<std::size_t>(offset);
  return 0;
}
int close_source(voidpf, voidpf) { return 0; }
int error_of_source(voidpf, voidpf) { return 0; }

struct CloseZip {
  void operator()(void* zip) const { unzClose(zip); }
};

}  // namespace

Result<std::string> read_zip_member(std::span<const std::uint8_t> archive, std::string_view ending,
                                    std::size_t most, const std::string& path) {
  PROBE_ASSIGN(std::optional<std::string> found, find_zip_member(archive, ending, most, path));
  if (found) return std::move(*found);
  return Failure{Fault::kUsage,
                 fmt::format("expected one `{}` in the zip archive, found 0", ending), path};
}

Result<std::optional<std::string>> find_zip_member(std::span<const std::uint8_t> archive,
                                                   std::string_view ending, std::size_t most,
                                                   const std::string& path) {
  const auto wrong = [&](std::string what) {
    return Failure{Fault::kUsage, std::move(what), path};
  };
  Source source{archive, 0};
  zlib_filefunc64_def calls{};
  calls.zopen64_file = open_source;
  calls.zread_file = read_source;
  calls.zwrite_file = write_source;
  calls.ztell64_file = tell_source;
  calls.zseek64_file = seek_source;
  calls.zclose_file = close_source;
  calls.zerror_file = error_of_source;
  calls.opaque = &source;
  const std::unique_ptr<void, CloseZip> zip(unzOpen2_64("", &calls));
  if (!zip) return wrong("no zip archive");

  unz64_file_pos wanted{};
  std::size_t found = 0, seen = 0;
  for (int at = unzGoToFirstFile(zip.get()); at != UNZ_END_OF_LIST_OF_FILE;
       at = unzGoToNextFile(zip.get())) {
    if (at != UNZ_OK) return wrong("the directory of the zip archive cannot be read");
    if (++seen > kMostMembers)
      return wrong(fmt::format("a zip archive of more than {} files", kMostMembers));
    std::array<char, 512> name{};
    unz_file_info64 info{};
    if (unzGetCurrentFileInfo64(zip.get(), &info, name.data(), name.size() - 1, nullptr, 0, nullptr,
                                0) != UNZ_OK) {
      return wrong("the directory of the zip archive cannot be read");
    }
    if (!std::string_view(name.data()).ends_with(ending)) continue;
    ++found;
    if (unzGetFilePos64(zip.get(), &wanted) != UNZ_OK)
      return wrong("the directory of the zip archive cannot be read");
  }
  if (found == 0) return std::optional<std::string>();
  if (found != 1)
    return wrong(fmt::format("expected one `{}` in the zip archive, found {}", ending, found));
  if (unzGoToFilePos64(zip.get(), &wanted) != UNZ_OK)
    return wrong("the directory of the zip archive cannot be read");
  unz_file_info64 info{};
  if (unzGetCurrentFileInfo64(zip.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    return wrong("the directory of the zip archive cannot be read");
  if ((info.flag & 1) != 0) return wrong(fmt::format("`{}` is encrypted", ending));
  if (info.uncompressed_size > allowed(most)) {
    return wrong(fmt::format("`{}` has {} bytes unpacked, at most {} are read{}", ending,
                             info.uncompressed_size, allowed(most), large_hint()));
  }
  if (unzOpenCurrentFile(zip.get()) != UNZ_OK)
    return wrong(fmt::format("`{}` is packed in a way that is not read", ending));
  // One byte more than it says, so that more is seen.
  std::string bytes(static_cast<std::size_t>(info.uncompressed_size) + 1, '\0');
  std::size_t size = 0;
  int count = 1;
  while (size < bytes.size() && count > 0) {
    const std::size_t room = std::min<std::size_t>(bytes.size() - size, std::size_t{1} << 20);
    count = unzReadCurrentFile(zip.get(), bytes.data() + size, static_cast<unsigned>(room));
    if (count > 0) size += static_cast<std::size_t>(count);
  }
  const int closed = unzCloseCurrentFile(zip.get());
  if (count < 0) return wrong(fmt::format("`{}` cannot be unpacked", ending));
  if (size != info.uncompressed_size) {
    return wrong(fmt::format("`{}` has {} bytes unpacked, the directory says {}", ending,
                             size > info.uncompressed_size ? "more" : std::to_string(size),
                             info.uncompressed_size));
  }
  if (closed == UNZ_CRCERROR)
    return wrong(
        fmt::format("`{}` is not what it was when it was packed: another checksum", ending));
  bytes.resize(size);
  return std::optional(std::move(bytes));
}

}  // namespace probe::libero
