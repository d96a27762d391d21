// The file: a head (what it is of, by which build), proofs without joints, proofs with, and a hash
// of all that.
#include "runtime/store/proof_book.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
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

ProofKeys::~ProofKeys() {
  if (file_ >= 0) ::close(file_);
}

std::optional<ProofKey> proof_key(const ResultRow& row) { return ProofKeys().of(row); }

std::optional<ProofKey> ProofKeys::of(const ResultRow& row) {
  const std::size_t slash = row.trace.rfind('/');
  if (slash == row.trace.npos) return std::nullopt;
  if (file_ < 0 || row.trace.compare(0, slash, folder_) != 0) {
    if (file_ >= 0) ::close(file_);
    folder_ = row.trace.substr(0, slash);
    file_ = ::open(folder_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  }
  struct stat file {};
  if (file_ < 0 || ::fstatat(file_, row.trace.c_str() + slash + 1, &file, 0) != 0 ||
      !S_ISREG(file.st_mode))
    return std::nullopt;
  const std::time_t now = std::time(nullptr);
  if (file.st_ctim.tv_sec + kCoarse >= now || file.st_mtim.tv_sec + kCoarse >= now)
    return std::nullopt;
  text_.clear();
  const auto number = [&](auto value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto words = [&](const std::string& value) {
    number(value.size());
    text_ += value;
  };
  for (const std::string* value :
       {&row.task, &row.policy, &row.prompt_sha256, &row.image_sha256, &row.frames_sha256,
        &row.trace_sha256, &row.episode_id, &row.start_id, &row.trace, &row.live})
    words(*value);
  for (const int value : {row.episode, row.seed, row.steps}) number(value);
  for (const auto* value :
       {&row.invalid, &row.sent_prompt_sha256, &row.sent_image_sha256, &row.remark}) {
    number(value->has_value());
    if (*value) words(**value);
  }
  for (const MetricValue& metric : row.metrics) {
    words(metric.name);
    number(metric.is_bool);
    number(metric.value);
  }
  for (const auto value : {static_cast<std::int64_t>(file.st_ino), std::int64_t{file.st_size},
                           std::int64_t{file.st_mtim.tv_sec}, std::int64_t{file.st_mtim.tv_nsec},
                           std::int64_t{file.st_ctim.tv_sec}, std::int64_t{file.st_ctim.tv_nsec}})
    number(value);
  const Sha256 hash = sha256(std::string_view(text_));
  ProofKey key;
  std::memcpy(key.bytes.data(), hash.bytes.data(), key.bytes.size());
  return key;
}

// Where the table has `key`, or would take it. Keys are hashes: their first bytes are as good as any.
ProofBook::Place& ProofBook::place_of(const ProofKey& key) {
  std::size_t at = 0;
  std::memcpy(&at, key.bytes.data(), sizeof at);
  for (at &= places_.size() - 1;; at = (at + 1) & (places_.size() - 1)) {
    Place& place = places_[at];
    if (place.key == key || place.key == ProofKey{}) return place;
  }
}

void ProofBook::make_room(std::size_t proofs) {
  if (2 * proofs < places_.size()) return;
  std::vector<Place> before(std::bit_ceil(2 * proofs + 2));
  before.swap(places_);
  for (const Place& place : before) {
    if (place.key != ProofKey{}) place_of(place.key) = place;
  }
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
  make_room(plain);
  for (std::size_t i = 0; i < plain; ++i) put(key(), {});
  while (from.ok() && from.left() > 0) {
    const ProofKey read = key();
    put(read, from.reals());
  }
  if (from.ok()) return;
  places_.clear();
  taken_ = 0;
}

ProofBook::Place& ProofBook::put(const ProofKey& key, std::vector<double> joints) {
  make_room(taken_ + 1);
  Place& place = place_of(key);
  if (place.key != key) ++taken_;
  place.key = key;
  if (joints.empty()) {
    place.joints = 0;
  } else {
    place.joints = static_cast<std::uint32_t>(joints_.size());
    joints_.push_back(std::move(joints));
  }
  return place;
}

const std::vector<double>* ProofBook::find(const ProofKey& key) const {
  if (places_.empty()) return nullptr;
  const Place& place = const_cast<ProofBook*>(this)->place_of(key);
  if (place.key != key || key == ProofKey{}) return nullptr;
  place.is_used = true;
  return &joints_[place.joints];
}

void ProofBook::add(const ProofKey& key, std::vector<double> joints) {
  put(key, std::move(joints)).is_used = true;
  has_new_ = true;
}

void ProofBook::keep() {
  std::size_t plain = 0, used = 0;
  for (const Place& place : places_) {
    used += place.is_used ? 1 : 0;
    plain += place.is_used && place.joints == 0 ? 1 : 0;
  }
  if (!has_new_ || path_.empty() || used < kWorthKeeping) return;
  ByteWriter body;
  body.u64(plain);
  const auto put = [&](const ProofKey& key) {
    for (const std::uint8_t byte : key.bytes) body.u8(byte);
  };
  for (const Place& place : places_) {
    if (place.is_used && place.joints == 0) put(place.key);
  }
  for (const Place& place : places_) {
    if (!place.is_used || place.joints == 0) continue;
    put(place.key);
    body.reals(joints_[place.joints]);
  }
  std::string text = head_;
  text.append(reinterpret_cast<const char*>(body.bytes().data()), body.bytes().size());
  const Sha256 hash = sha256(std::string_view(text));
  text.append(reinterpret_cast<const char*>(hash.bytes.data()), hash.bytes.size());
  if (!make_folders(path_.substr(0, path_.rfind('/')))) return;
  if (write_file(path_, std::as_bytes(std::span(text)))) has_new_ = false;
}

}  // namespace probe::store
