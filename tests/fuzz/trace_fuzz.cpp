// Any bytes as a trace file: the reader refuses, or gives whole steps. The input is taken as the
// file itself and, compressed, as its content with fresh check words.
// links: probe_store zstd
#include <sys/mman.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/sha256.h"
#include "runtime/store/trace.h"
#include "runtime/store/trace_codec.h"

namespace {

using namespace probe;

void need(bool truth) {
  if (!truth) std::abort();
}

// A file in memory: the reader opens it by its name in /proc.
int memory_file() {
  static const int file = memfd_create("trace", MFD_CLOEXEC);
  return file;
}
const std::string& path() {
  static const std::string name = "/proc/self/fd/" + std::to_string(memory_file());
  return name;
}

void read(const void* data, std::size_t size) {
  need(ftruncate(memory_file(), 0) == 0);
  need(size == 0 || pwrite(memory_file(), data, size, 0) == static_cast<ssize_t>(size));
  const auto whole = store::read_trace(path());
  const auto prefix = store::read_trace_prefix(path());
  if (whole.ok()) {
    need(prefix.ok() && prefix->incomplete.empty());
    need(whole->end.has_value() && whole->end->steps == whole->steps.size());
    return;
  }
  need(!whole.failure().message.empty());
  if (prefix.ok()) need(!prefix->incomplete.empty());
}

// The input as chunks: a byte chooses the tag, two the size of the payload that follows.
std::vector<std::byte> as_content(const std::uint8_t* data, std::size_t size) {
  using store::codec::Tag;
  constexpr Tag kTags[] = {Tag::kHead, Tag::kFingerprint, Tag::kSettled, Tag::kTime,
                           Tag::kStep, Tag::kDone,        Tag::kHash};
  std::vector<std::byte> out;
  const auto put = [&](const void* from, std::size_t count) {
    const auto* begin = static_cast<const std::byte*>(from);
    out.insert(out.end(), begin, begin + count);
  };
  put(store::codec::kMagic.data(), store::codec::kMagic.size());
  const std::uint32_t head[2] = {store::codec::kVersion, 0};
  put(head, sizeof head);
  while (size > 3) {
    const auto tag = static_cast<std::uint32_t>(kTags[data[0] % std::size(kTags)]);
    const auto length =
        static_cast<std::uint32_t>(std::min<std::size_t>(size - 3, data[1] + 256u * data[2]));
    const std::size_t begin = out.size();
    put(&tag, sizeof tag);
    put(&length, sizeof length);
    put(data + 3, length);
    const Sha256 check = sha256(std::span<const std::byte>(out).subspan(begin));
    put(check.bytes.data(), 8);
    data += 3 + length;
    size -= 3 + length;
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read(data, size);
  const auto content = as_content(data, size);
  std::vector<char> packed(ZSTD_compressBound(content.size()));
  const std::size_t bytes =
      ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 1);
  need(ZSTD_isError(bytes) == 0);
  read(packed.data(), bytes);
  return 0;
}
