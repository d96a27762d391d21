#include "runtime/plan/plan.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "runtime/base/io_failure.h"

namespace probe::plan {

// Owns the bytes: a read-only mapping, or a vector.
class Plan::Storage {
 public:
  explicit Storage(std::vector<std::byte> bytes) : owned_(std::move(bytes)), bytes_(owned_) {}
  Storage(void* mapping, std::size_t size)
      : mapping_(mapping), bytes_(static_cast<const std::byte*>(mapping), size) {}
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;
  ~Storage() {
    if (mapping_ != nullptr) ::munmap(mapping_, bytes_.size());
  }

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  void* mapping_ = nullptr;
  std::vector<std::byte> owned_;
  std::span<const std::byte> bytes_;
};

namespace {

class File {
 public:
  explicit File(const std::string& path)
      : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  int fd() const { return fd_; }

 private:
  int fd_;
};

Failure not_read(const std::string& path) { return io_failure("cannot read the plan", path); }

template <typename Record>
std::optional<std::uint32_t> find_name(const Tables& t, std::span<const Record> table,
                                       std::string_view name) {
  const auto it =
      std::ranges::find_if(table, [&](const Record& r) { return t.text(r.name) == name; });
  if (it == table.end()) return std::nullopt;
  return static_cast<std::uint32_t>(it - table.begin());
}

}  // namespace

Plan::Plan(std::unique_ptr<Storage> storage)
    : storage_(std::move(storage)), tables_(view_tables(storage_->bytes())) {}
Plan::Plan(Plan&&) noexcept = default;
Plan& Plan::operator=(Plan&&) noexcept = default;
Plan::~Plan() = default;

Result<Plan> Plan::adopt(std::unique_ptr<Storage> storage, const VerifyOptions& options) {
  PROBE_TRY(verify(storage->bytes(), options));
  return Plan(std::move(storage));
}

Result<Plan> Plan::open(const std::string& path, const VerifyOptions& options) {
  const File file(path);
  if (file.fd() < 0) return not_read(path);
  struct stat info {};
  if (::fstat(file.fd(), &info) != 0) return not_read(path);
  if (!S_ISREG(info.st_mode)) return Failure{Fault::kIo, "a plan is a regular file", path};
  const auto size = static_cast<std::size_t>(info.st_size);
  if (size == 0) return Failure{Fault::kPlan, "the file is empty", path};
  void* mapping = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd(), 0);
  if (mapping == MAP_FAILED) return not_read(path);
  Result<Plan> plan = adopt(std::make_unique<Storage>(mapping, size), options);
  if (plan.ok()) return plan;
  Failure failure = plan.failure();
  failure.where = failure.where.empty() ? path : path + ": " + failure.where;
  return failure;
}

Result<Plan> Plan::from_bytes(std::vector<std::byte> bytes, const VerifyOptions& options) {
  return adopt(std::make_unique<Storage>(std::move(bytes)), options);
}

Sha256 Plan::root() const {
  Header header;
  std::memcpy(&header, storage_->bytes().data(), sizeof header);
  return Sha256{header.root};
}

std::span<const std::byte> Plan::bytes() const { return storage_->bytes(); }

std::span<const DriveRecord> Plan::drives(const RobotRecord& r) const {
  return slice_of(tables_.drives, r.drives);
}
std::span<const GearRecord> Plan::gears(const RobotRecord& r) const {
  return slice_of(tables_.gears, r.gears);
}
std::span<const double> Plan::home(const LawRecord& l) const {
  return slice_of(tables_.reals, l.home);
}
std::span<const std::uint32_t> Plan::meshes(const RobotRecord& r) const {
  return slice_of(tables_.list, r.meshes);
}
std::span<const SunRecord> Plan::suns(const LightRecord& l) const {
  return slice_of(tables_.suns, l.suns);
}
std::span<const double> Plan::joints(const SceneRecord& s) const {
  return slice_of(tables_.reals, s.joints);
}
std::span<const std::uint32_t> Plan::fixtures(const SceneRecord& s) const {
  return slice_of(tables_.list, s.fixtures);
}
std::span<const FixtureJointRecord> Plan::joints(const FixtureRecord& f) const {
  return slice_of(tables_.fixture_joints, f.joints);
}
std::span<const PartRecord> Plan::parts(const FixtureRecord& f) const {
  return slice_of(tables_.parts, f.parts);
}
std::span<const std::uint32_t> Plan::meshes(const FixtureRecord& f) const {
  return slice_of(tables_.list, f.meshes);
}
std::span<const double> Plan::constants(const ProgramRecord& p) const {
  return slice_of(tables_.constants, p.constants);
}
std::span<const StateRecord> Plan::states(const ProgramRecord& p) const {
  return slice_of(tables_.states, p.states);
}
std::span<const Instruction> Plan::code(const ProgramRecord& p) const {
  return slice_of(tables_.code, p.code);
}
std::span<const MetricRecord> Plan::metrics(const ProgramRecord& p) const {
  return slice_of(tables_.metrics, p.metrics);
}
std::span<const MetricRecord> Plan::metrics(const TaskRecord& k) const {
  return metrics(programs()[k.program]);
}
std::span<const BodyRecord> Plan::bodies(const TaskRecord& k) const {
  return slice_of(tables_.bodies, k.bodies);
}
std::span<const EpisodeRecord> Plan::episodes(const TaskRecord& k) const {
  return slice_of(tables_.episodes, k.episodes);
}
std::span<const PlacementRecord> Plan::placements(const EpisodeRecord& e) const {
  return slice_of(tables_.placements, e.placements);
}
std::span<const std::uint32_t> Plan::members(const SetRecord& s) const {
  return slice_of(tables_.list, s.members);
}
std::span<const std::uint32_t> Plan::members(const SuiteRecord& s) const {
  return slice_of(tables_.list, s.members);
}
std::span<const std::uint32_t> Plan::seeds(const SuiteRecord& s) const {
  return slice_of(tables_.list, s.seeds);
}

std::vector<std::uint32_t> Plan::episodes(const SuiteRecord& s, std::uint32_t task) const {
  const Slice own = tasks()[task].episodes;
  std::vector<std::uint32_t> numbers;
  if (s.episodes.count == 0) {
    numbers.resize(own.count);
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
  }
  const auto drawn = slice_of(tables_.list, s.episodes);
  for (auto at = std::ranges::lower_bound(drawn, own.first);
       at != drawn.end() && *at - own.first < own.count; ++at)
    numbers.push_back(*at - own.first);
  return numbers;
}
std::size_t Plan::episode_count(const SuiteRecord& s) const {
  if (s.episodes.count > 0) return s.episodes.count;
  std::size_t count = 0;
  for (const std::uint32_t task : members(s)) count += tasks()[task].episodes.count;
  return count;
}

std::vector<ViewRecord> Plan::views(const TaskRecord& t) const {
  const auto stored = slice_of(tables_.views, t.views);
  if (!stored.empty()) return {stored.begin(), stored.end()};
  return {{tables_.cameras[t.camera].name, t.camera, tables_.scenes[t.scene].photo}};
}

std::optional<std::uint32_t> Plan::find_task(std::string_view name) const {
  if (const auto found = find_name(tables_, tables_.tasks, name)) return found;
  for (const SuiteRecord& suite : suites()) {
    const std::string_view prefix = text(suite.prefix);
    if (prefix.empty() || !name.starts_with(prefix)) continue;
    if (const auto found = find_name(tables_, tables_.tasks, name.substr(prefix.size())))
      return found;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> Plan::find_suite(std::string_view name) const {
  return find_name(tables_, tables_.suites, name);
}
std::optional<std::uint32_t> Plan::find_set(std::string_view name) const {
  return find_name(tables_, tables_.sets, name);
}
std::optional<std::uint32_t> Plan::ends_metric(const TaskRecord& task) const {
  const auto all = metrics(task);
  const auto at =
      std::ranges::find(all, static_cast<std::uint32_t>(Readout::kEnds), &MetricRecord::readout);
  if (at == all.end()) return std::nullopt;
  return static_cast<std::uint32_t>(at - all.begin());
}

std::optional<std::uint32_t> Plan::find_metric(const TaskRecord& task,
                                               std::string_view name) const {
  return find_name(tables_, metrics(task), name);
}

std::span<const SpanRecord> Plan::spans_of(SpanKind what, std::uint32_t index) const {
  const auto key = [](const SpanRecord& s) { return std::pair(s.what, s.index); };
  const std::pair wanted(static_cast<std::uint32_t>(what), index);
  // The two ends apart: clang 14 does not compile the subrange that equal_range gives.
  const auto all = spans();
  return {std::ranges::lower_bound(all, wanted, {}, key),
          std::ranges::upper_bound(all, wanted, {}, key)};
}
const SpanRecord* Plan::span_of(SpanKind what, std::uint32_t index) const {
  const auto found = spans_of(what, index);
  return found.empty() ? nullptr : found.data();
}

}  // namespace probe::plan
