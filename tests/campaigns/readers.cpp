// Whatever is read of others: whole files and messages of each kind with one to four damages, or
// two of a kind spliced together. A reader takes them or refuses them with a reason; one that dies,
// takes over ten seconds or over a gigabyte, or has no reason to say is a finding, and so is one
// that refuses what is whole, as one in sixteen is.
//   campaign_readers [KIND..] [--for SECONDS | --count N] [--from SEED] [--only SEED]
// A seed is one damaged file, always the same. Exit 0: no finding.
#include <algorithm>
#include <fstream>
#include <iterator>

#include "tests/campaigns/driver.h"
#include "tests/campaigns/kinds.h"
#include "tests/runtime/scene/mutate.h"

namespace probe::campaign {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "campaign_readers";
constexpr std::size_t kLargest = std::size_t{1} << 20;  // bytes of a damaged file

struct Damaged {
  std::string name, bytes;
};

// Of two samples of a form the head of one and the tail of the other, or one of them; damaged.
Damaged damaged_sample(const Kind& kind, std::uint64_t seed, bool is_whole) {
  scene::test::Dice dice(seed * 0x9e3779b97f4a7c15ull);
  const Sample& one = kind.samples[dice.below(kind.samples.size())];
  Damaged out{one.name, one.bytes};
  if (is_whole) return out;
  const Sample& other = kind.samples[dice.below(kind.samples.size())];
  if (kind.damage == nullptr && dice.below(8) == 0 &&
      fs::path(one.name).extension() == fs::path(other.name).extension() && !other.bytes.empty() &&
      !one.bytes.empty()) {
    out.bytes = one.bytes.substr(0, dice.below(one.bytes.size())) +
                other.bytes.substr(dice.below(other.bytes.size()));
  }
  out.bytes = kind.damage ? kind.damage(std::move(out.bytes), seed)
                          : damaged(std::move(out.bytes), form_of(one.name), seed);
  if (out.bytes.size() > kLargest) out.bytes.resize(kLargest);
  return out;
}

// Which kind a seed is of, and whether of one that is whole. Round by round each has a turn; in
// most rounds those that wait leave theirs to others.
struct Turn {
  std::size_t kind;
  bool is_whole;
};
Turn turn_of(std::uint64_t seed, const std::vector<Kind>& kinds) {
  const std::uint64_t round = seed / kinds.size();
  std::size_t kind = seed % kinds.size();
  if (kinds[kind].waits && round % 64 >= 4) {
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (!kinds[i].waits) others.push_back(i);
    }
    if (!others.empty()) kind = others[(seed + round) % others.size()];
  }
  return {kind, round % 16 == 0};
}

// By this process and those that it waited for, where files are parsed apart.
struct Spent {
  long most_kb = 0;
  double seconds = 0;
};
Spent spent() {
  Spent all;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    all.most_kb = std::max(all.most_kb, used.ru_maxrss);
    for (const timeval& time : {used.ru_utime, used.ru_stime})
      all.seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return all;
}

// What must not be, if anything.
std::string fault_of(const Status& status, bool is_whole, const Spent& before, const Spent& after) {
  if (!status.ok() && is_whole) return "refused, though whole: " + to_text(status.failure());
  if (!status.ok() &&
      (status.failure().message.empty() || status.failure().code == Fault::kInternal))
    return "a refusal without a reason: " + to_text(status.failure());
  if (after.most_kb - before.most_kb > (1 << 20)) return "took over a gigabyte";
  if (after.seconds - before.seconds > 10) return "took over ten seconds";
  return {};
}

// A folder of its own, which only the process that made it removes.
class Work {
 public:
  Work() : path(fs::temp_directory_path() / ("vlaprobe_readers_" + std::to_string(getpid()))) {
    fs::create_directories(path);
  }
  ~Work() {
    std::error_code error;
    fs::remove_all(path, error);
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  const fs::path path;
};

int attack(const Options& options) {
  const Work work;
  std::vector<Kind> kinds;
  add_files(kinds, work.path);
  add_folders(kinds, work.path);
  add_messages(kinds);
  add_conversations(kinds, work.path);
  std::erase_if(kinds, [&](const Kind& kind) {
    return !options.words.empty() &&
           std::ranges::find(options.words, kind.name) == options.words.end();
  });
  for (const Kind& kind : kinds) {
    if (kind.samples.empty()) {
      std::fprintf(stderr, "%s: %s has no file to damage\n", kName, kind.name);
      return 2;
    }
  }
  if (kinds.empty()) {
    std::fprintf(stderr, "%s: no such kind\n", kName);
    return 2;
  }
  return run(
      options, {.seconds = 20, .memory = rlim_t{4} << 30},
      [&](Tally& tally) {
        const auto [which, is_whole] = turn_of(tally.seed, kinds);
        const Kind& kind = kinds[which];
        const Damaged file = damaged_sample(kind, tally.seed, is_whole);
        const std::string path = (work.path / fs::path(file.name).filename()).string();
        write_text(path, file.bytes);
        const auto before = spent();
        const Status status = kind.read({file.name, path, file.bytes, is_whole});
        ++tally.counts[2 * which + (status.ok() ? 0 : 1)];
        const std::string fault = fault_of(status, is_whole, before, spent());
        if (!fault.empty()) tally.find(std::string(kind.name) + ": " + fault);
      },
      [&](const Tally& tally) {
        for (std::size_t i = 0; i < kinds.size(); ++i)
          std::printf("%-16s %9llu taken %9llu refused\n", kinds[i].name,
                      static_cast<unsigned long long>(tally.counts[2 * i]),
                      static_cast<unsigned long long>(tally.counts[2 * i + 1]));
      });
}

}  // namespace

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::vector<Sample> files_in(const fs::path& folder, const std::string& ending,
                             std::size_t most_bytes) {
  std::vector<Sample> samples;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && (ending.empty() || entry.path().extension() == ending) &&
        entry.file_size() <= most_bytes)
      samples.push_back(
          {fs::relative(entry.path(), folder).generic_string(), text_of(entry.path())});
  }
  std::ranges::sort(samples, {}, &Sample::name);
  return samples;
}

void make_apart(const char* what, const std::function<Status()>& make) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const Status made = make();
    if (!made.ok()) std::fprintf(stderr, "%s\n", to_text(made.failure()).c_str());
    std::fflush(nullptr);
    _exit(made.ok() ? 0 : 1);
  }
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && status == 0) return;
  std::fprintf(stderr, "%s: %s cannot be made\n", kName, what);
  std::exit(2);
}

}  // namespace probe::campaign

int main(int argc, char** argv) {
  using namespace probe::campaign;
  return attack(read_options("campaign_readers", argc, argv));
}
