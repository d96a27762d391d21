// What was found of tasks when a text was looked at before. A key typed in a suite of thousands
// changes few of them: what follows from the fields of the others, and that nothing is to be said of
// them, is known by what they are made of. A task is known by a key of all that it can depend on, so
// nothing that is remembered is ever wrong; a task for which that is not plain has no key and is
// looked at each time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/names/context.h"
#include "runtime/robot/urdf.h"

namespace probe::sema {

// A check that remembers of which tasks it had nothing to say.
enum class Silent : std::uint8_t {
  kPhrases,
  kGoals,
  kMentions,
  kNamed,
  kStarts,
  kRepeated,
  kMetrics,
};

class Remembered {
 public:
  // Two lanes: among the millions of tasks of a long session no two keys are equal by chance.
  struct Key {
    std::uint64_t a = 0, b = 0;
    bool operator==(const Key&) const = default;
    bool is_none() const { return a == 0 && b == 0; }
  };
  // What follows from the fields of a task in which nothing was amiss.
  struct Followed {
    std::vector<ObjectId> placed;
    std::string prompt;
    std::uint32_t ood = 0;
    std::uint64_t met = 0;  // in which analysis, last
  };

  // All that tasks are made of is defined, and no task yet.
  void begin(const Context& context);
  // Of task `index`, whose statements were read; null where it is not known.
  const Followed* followed(const Model& model, std::uint32_t index, const Task& task);
  // Task `index` has no key.
  void forget(std::uint32_t index);
  void keep(std::uint32_t index, const Task& task);
  // What differs between the two.
  std::optional<std::uint32_t> axes(std::uint32_t index, std::uint32_t baseline);
  void keep_axes(std::uint32_t index, std::uint32_t baseline, std::uint32_t axes);

  // What a binder of words stands for in the variants of a task: templates, by number. Null where it
  // is not known, or where task `index` has no key.
  const std::vector<std::uint32_t>* choices(std::uint32_t index, std::string_view frame);
  void keep_choices(std::uint32_t index, std::string_view frame, std::vector<std::uint32_t> found);

  // The starts of a layout, by all that they depend on beside declarations: its number comes first.
  const std::vector<Start>* starts(LayoutId layout, const std::vector<double>& made_of);
  void keep_starts(LayoutId layout, const std::vector<double>& made_of,
                   const std::vector<Start>& starts);

  // Which file of assets it is, and when and how large it was written.
  static Key stamp_of(const std::string& path);
  // A file of URDF as it was read before; null where it has changed. The stamp that is kept with it
  // was taken before it was read.
  const robot::RobotModel* described(const std::string& path);
  void keep_described(const std::string& path, const Key& stamp, const robot::RobotModel& model);

  // All tasks are defined.
  void begin_checks(const Model& model);
  bool is_silent(std::size_t index, Silent check) const;
  void keep_silent(std::size_t index, Silent check);

 private:
  struct Compared {
    std::optional<std::uint32_t> axes;
    std::uint32_t silent = 0;  // a bit a check
    std::uint64_t met = 0;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const { return static_cast<std::size_t>(key.a); }
  };

  Key key_of(const Model& model, const Task& task);
  const Key& words_key(const Model& model, TemplateId say);
  const Key& light_key(const Model& model, LightId light);
  Key key_at(std::size_t index) const { return index < keys_.size() ? keys_[index] : Key{}; }
  Compared* compared(const Key& task, const Key& baseline);
  std::optional<Key> choices_key(std::uint32_t index, std::string_view frame) const;
  Key starts_key(LayoutId layout, const std::vector<double>& made_of) const;
  void drop_old();

  std::unordered_map<Key, Followed, Hash> followed_;
  std::unordered_map<Key, Compared, Hash> compared_;
  std::unordered_map<Key, std::pair<std::vector<std::uint32_t>, std::uint64_t>, Hash> choices_;
  std::unordered_map<Key, std::pair<std::vector<Start>, std::uint64_t>, Hash> starts_;
  std::map<std::string, std::pair<Key, robot::RobotModel>> described_;  // by path, with its stamp
  std::uint64_t analysis_ = 0;

  // Of this analysis.
  Key made_of_;  // all that tasks are made of, but for lights, layouts and what they add themselves
  std::size_t objects_ = 0, scenes_ = 0, cameras_ = 0;  // how many were declared
  std::vector<Key> layouts_;                            // by id
  bool names_objects_ = false;                          // by expressions that are declared
  std::set<std::string, std::less<>> spatial_;  // names of phrases that say where things are
  std::vector<Key> words_, lights_;             // by id
  std::vector<Key> keys_;                       // by task
  std::vector<Compared*> checked_;              // by task
};

// A check's way over the tasks: passes over those of which it is known that there is nothing to
// say, and remembers of which of the others nothing was said.
class Silence {
 public:
  // Of a check that says some things once, of the first task that they hold of, no task is
  // remembered behind one that it spoke of.
  enum class Says { kOfEach, kOnce };
  Silence(const Model& model, const Reporter& reporter, Silent check, Says says = Says::kOfEach)
      : model_(model),
        reporter_(reporter),
        memory_(reporter.depth.remembered),
        check_(check),
        says_(says),
        first_(reporter.diagnostics.size()) {}
  ~Silence() { end(); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

  // Whether nothing is to be said of a task of the model; what is said until the next call is said
  // of this one.
  bool is_known(const Task& task);
  // Something was not said of it as it had been said before.
  void hold_back() { is_open_ = false; }

 private:
  void end();

  const Model& model_;
  const Reporter& reporter_;
  Remembered* memory_;
  Silent check_;
  Says says_;
  std::size_t first_;       // what had been said when the check began
  std::size_t before_ = 0;  // and before the task
  std::size_t index_ = 0;
  bool is_open_ = false;
};

}  // namespace probe::sema
