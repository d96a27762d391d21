#include "runtime/base/sha256.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <bit>

#include "runtime/base/check.h"

namespace probe {

static_assert(std::endian::native == std::endian::little, "hashes and plans are little endian");

namespace {

// Looked up once: EVP_sha256() asks all providers by name, under a lock, at every hash that begins.
const EVP_MD* sha256_method() {
  static const EVP_MD* const kMethod = EVP_MD_fetch(nullptr, "SHA2-256", nullptr);
  return kMethod;
}

}  // namespace

// Ids are made of numbers and of other hashes: they are gathered, because an update costs more than
// the copy of a few bytes.
struct Hasher::Context {
  EVP_MD_CTX* md = EVP_MD_CTX_new();
  std::array<std::byte, 512> gathered{};
  std::size_t size = 0;
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { EVP_MD_CTX_free(md); }

  void update(std::span<const std::byte> data) const {
    PROBE_CHECK(EVP_DigestUpdate(md, data.data(), data.size()) == 1, "SHA-256 must update");
  }
  void flush() {
    update(std::span(gathered).first(size));
    size = 0;
  }
};

Hasher::Hasher() : context_(std::make_unique<Context>()) {
  PROBE_CHECK(EVP_DigestInit_ex(context_->md, sha256_method(), nullptr) == 1, "SHA-256 must start");
}
Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher& Hasher::operator=(Hasher&&) noexcept = default;

Hasher& Hasher::bytes(std::span<const std::byte> data) {
  Context& context = *context_;
  if (data.size() > context.gathered.size() - context.size) context.flush();
  if (data.size() > context.gathered.size()) {
    context.update(data);
    return *this;
  }
  std::copy(data.begin(), data.end(), context.gathered.begin() + context.size);
  context.size += data.size();
  return *this;
}

Hasher& Hasher::text(std::string_view value) {
  u64(value.size());
  return bytes(std::as_bytes(std::span(value.data(), value.size())));
}

Hasher& Hasher::u8(std::uint8_t value) { return bytes(std::as_bytes(std::span(&value, 1))); }
Hasher& Hasher::u32(std::uint32_t value) { return bytes(std::as_bytes(std::span(&value, 1))); }
Hasher& Hasher::u64(std::uint64_t value) { return bytes(std::as_bytes(std::span(&value, 1))); }

Hasher& Hasher::f64(double value) {
  return u64(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value));
}

Hasher& Hasher::f64s(std::span<const double> values) {
  for (double value : values) f64(value);
  return *this;
}

Hasher& Hasher::hash(const Sha256& value) { return bytes(std::as_bytes(std::span(value.bytes))); }

Sha256 Hasher::finish() {
  context_->flush();
  Sha256 out;
  unsigned int size = 0;
  PROBE_CHECK(EVP_DigestFinal_ex(context_->md, out.bytes.data(), &size) == 1 && size == 32,
              "SHA-256 must finish");
  return out;
}

Sha256 sha256(std::span<const std::byte> data) { return Hasher().bytes(data).finish(); }

Sha256 sha256(std::string_view text) {
  return sha256(std::as_bytes(std::span(text.data(), text.size())));
}

std::string to_hex(const Sha256& hash) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  out.reserve(64);
  for (std::uint8_t byte : hash.bytes) {
    out.push_back(kDigits[byte >> 4]);
    out.push_back(kDigits[byte & 15]);
  }
  return out;
}

}  // namespace probe
