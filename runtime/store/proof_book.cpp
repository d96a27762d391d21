// The file: a head (what it is of, by which build), proofs without joints, proofs with, and a hash
// of all that.
#include "runtime/store/proof_book.h"

#include <sys/stat.h>

#include <cstring>
#include <ctime>
#include <utility>

#include "runtime/base/bytes.h"
#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/base/sha256.h"
#include "runtime/store/fingerprint.h"

namespace probe::store {
namespace {

// Stamps of two changes within so many seconds may be equal: clocks of file systems are coarse.
constexpr std::time_t kCoarse = 2;

constexpr std::string_view kMagic = "vlaprobe proofs 1\n";

}  // namespace

std::optional<ProofKey> proof_key(const ResultRow& row) {
  struct stat file {};
  if (::stat(row.trace.c_str(), &file) != 0 || !S_ISREG(file.st_mode)) return std::nullopt;
  const std::time_t now = std::time(nullptr);
  if (file.st_ctim.tv_sec + kCoarse >= now || file.st_mtim.tv_sec + kCoarse >= now)
    return std::nullopt;
  ByteWriter text;
  for (const std::string* value :
       {&row.task, &row.policy, &row.prompt_sha256, &row.image_sha256, &row.frames_sha256,
        &row.trace_sha256, &row.episode_id, &row.start_id, &row.trace, &row.live})
    text.text(*value);
  for (const int value : {row.episode, row.seed, row.steps})
    text.u32(static_cast<std::uint32_t>(value));
  for (const auto* value :
       {&row.invalid, &row.sent_prompt_sha256, &row.sent_image_sha256, &row.remark}) {
    text.u8(*value ? 1 : 0);
    text.text(value->value_or(""));
  }
  for (const MetricValue& metric : row.metrics) {
    text.text(metric.name);
    text.u8(metric.is_bool ? 1 : 0);
    text.f64(metric.value);
  }
  for (const auto value : {static_cast<std::int64_t>(file.st_ino), std::int64_t{file.st_size},
                           std::int64_t{file.st_mtim.tv_sec}, std::int64_t{file.st_mtim.tv_nsec},
                           std::int64_t{file.st_ctim.tv_sec}, std::int64_t{file.st_ctim.tv_nsec}})
    text.u64(static_cast<std::uint64_t>(value));
  const Sha256 hash = sha256(std::span(text.bytes()));
  ProofKey key;
  std::memcpy(key.bytes.data(), hash.bytes.data(), key.bytes.size());
  return key;
}

std::size_t ProofBook::Hash::operator()(const ProofKey& key) const {
  std::size_t value = 0;
  std::memcpy(&value, key.bytes.data(), sizeof value);
  return value;
}

ProofBook::ProofBook(const std::string& dir, const plan::Plan& plan, const std::string& folder) {
  const std::string build = own_build_id();
  if (folder.empty() || build.empty()) return;
  const std::string place = absolute_path(dir);
  path_ = folder + "/" + to_hex(sha256(std::string_view(place))).substr(0, 32);
  head_ = std::string(kMagic) + build + "\n" + to_hex(plan.root()) + "\n" + place + "\n";
  const auto text = read_file(path_);
  if (!text || !text->starts_with(head_) || text->size() < head_.size() + sizeof(Sha256)) return;
  const auto bytes = std::as_bytes(std::span(*text));
  const Sha256 hash = sha256(bytes.first(bytes.size() - sizeof(Sha256)));
  if (std::memcmp(hash.bytes.data(), bytes.data() + bytes.size() - sizeof(Sha256),
                  sizeof(Sha256)) != 0)
    return;
  ByteReader from(bytes.subspan(head_.size(), bytes.size() - head_.size() - sizeof(Sha256)));
  const auto key = [&] {
    ProofKey read;
    const auto taken = from.take(read.bytes.size());
    if (!taken.empty()) std::memcpy(read.bytes.data(), taken.data(), taken.size());
    return read;
  };
  const std::size_t plain = from.count(from.u64(), sizeof(ProofKey));
  proofs_.reserve(plain);
  for (std::size_t i = 0; i < plain; ++i) proofs_.try_emplace(key());
  while (from.ok() && from.left() > 0) {
    const ProofKey read = key();
    proofs_[read].joints = from.reals();
  }
  if (!from.ok()) proofs_.clear();
}

const std::vector<double>* ProofBook::find(const ProofKey& key) const {
  const auto at = proofs_.find(key);
  if (at == proofs_.end()) return nullptr;
  at->second.is_used = true;
  return &at->second.joints;
}

void ProofBook::add(const ProofKey& key, std::vector<double> joints) {
  Entry& entry = proofs_[key];
  entry.joints = std::move(joints);
  entry.is_used = true;
  has_new_ = true;
}

void ProofBook::keep() {
  std::size_t plain = 0, used = 0;
  for (const auto& [key, entry] : proofs_) {
    used += entry.is_used ? 1 : 0;
    plain += entry.is_used && entry.joints.empty() ? 1 : 0;
  }
  if (!has_new_ || path_.empty() || used < kWorthKeeping) return;
  ByteWriter body;
  body.u64(plain);
  const auto put = [&](const ProofKey& key) {
    for (const std::uint8_t byte : key.bytes) body.u8(byte);
  };
  for (const auto& [key, entry] : proofs_) {
    if (entry.is_used && entry.joints.empty()) put(key);
  }
  for (const auto& [key, entry] : proofs_) {
    if (!entry.is_used || entry.joints.empty()) continue;
    put(key);
    body.reals(entry.joints);
  }
  std::string text = head_;
  text.append(reinterpret_cast<const char*>(body.bytes().data()), body.bytes().size());
  const Sha256 hash = sha256(std::string_view(text));
  text.append(reinterpret_cast<const char*>(hash.bytes.data()), hash.bytes.size());
  if (!make_folders(path_.substr(0, path_.rfind('/')))) return;
  if (write_file(path_, std::as_bytes(std::span(text)))) has_new_ = false;
}

}  // namespace probe::store
