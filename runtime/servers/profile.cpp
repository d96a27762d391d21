// The table of fields, and the reading and writing of a profile by it.
#include "runtime/servers/profile.h"

#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <type_traits>
#include <variant>

#include "runtime/base/sha256.h"
#include "runtime/base/spelling.h"
#include "runtime/servers/profile_check.h"
#include "runtime/servers/profile_words.h"

namespace probe::servers {
namespace {

// What a field is stored in, and so how it is read and written.
struct Count {
  int* value;
  int most;
  std::string_view zero;  // how 0 is written; empty: it may not be
};
struct Number {
  double* value;
  double most;  // and more than 0
};
using Slot = std::variant<std::string*, Count, Number, std::optional<double>*, std::vector<double>*,
                          std::vector<ImageRule>*, std::vector<StateRule>*, ActionForm*,
                          ActionUnits*, Protocol*, StateLayout*, StateFrame*, NumberType*,
                          Normalisation*, RotationForm*, GripperRange*, StickyRule*, PromptCase*,
                          FullStop*, Ensemble*, ConnectionUse*, CheckpointUse*, WorldsAtOnce*>;

struct Field {
  std::string_view name;
  Slot (*slot)(Profile&);
  std::string_view meaning;
};

constexpr int kMostActions = 1000;   // of a chunk
constexpr double kLongest = 86'400;  // seconds
constexpr std::size_t kMostNumbers = 64;
constexpr int kLargestSide = 4096;

// The order is that of to_text and of the help.
constexpr Field kFields[] = {
    {"protocol", [](Profile& p) -> Slot { return &p.protocol; }, "what the server speaks"},
    {"about", [](Profile& p) -> Slot { return &p.about; }, "a sentence for people"},
    {"image", [](Profile& p) -> Slot { return &p.images; },
     "CAMERA -> KEY [WIDTHxHEIGHT stretch|pad|crop|lanczos|cv2_linear|cv2_area|tf_lanczos3] "
     "[jpeg95] [hwc_u8|chw_f32]; CAMERA `first` is the scene's first; one line each"},
    {"prompt.key", [](Profile& p) -> Slot { return &p.prompt_key; }, "the instruction's key"},
    {"prompt.case", [](Profile& p) -> Slot { return &p.prompt_case; }, ""},
    {"prompt.full_stop", [](Profile& p) -> Slot { return &p.prompt_full_stop; },
     "at the instruction's end"},
    {"state.key", [](Profile& p) -> Slot { return &p.state_key; }, "the state's key"},
    {"state.layout", [](Profile& p) -> Slot { return &p.state_layout; },
     "of the end effector in the base frame; wxyz a quaternion, rpy fixed axes, m and rad"},
    {"state.frame", [](Profile& p) -> Slot { return &p.state_frame; },
     "rotations relative to the base, or to the tool pointing down (BridgeData)"},
    {"state.type", [](Profile& p) -> Slot { return &p.state_type; }, ""},
    {"state.normalise", [](Profile& p) -> Slot { return &p.state_statistics.kind; },
     "what the client does before it sends; servers usually do it themselves"},
    {"state.low", [](Profile& p) -> Slot { return &p.state_statistics.low; },
     "bound: is sent as -1"},
    {"state.high", [](Profile& p) -> Slot { return &p.state_statistics.high; },
     "bound: is sent as 1"},
    {"state.mean", [](Profile& p) -> Slot { return &p.state_statistics.mean; }, "gaussian"},
    {"state.std", [](Profile& p) -> Slot { return &p.state_statistics.std; }, "gaussian"},
    {"state.mask", [](Profile& p) -> Slot { return &p.state_statistics.mask; },
     "1 for a number that is normalised, 0 for one that is not"},
    {"state.more", [](Profile& p) -> Slot { return &p.more_states; },
     "KEY LAYOUT: a state under a key of its own, not normalised; openpi; one line each"},
    {"action.form", [](Profile& p) -> Slot { return &p.action_form; },
     "a change of the pose each step, or the pose to be at, in the base frame; the arm's joints to "
     "be at, rad, or what they change by"},
    {"action.units", [](Profile& p) -> Slot { return &p.action_units; },
     "of all numbers but the gripper's: m and rad; -1 to 1 each, or of length 1 at most, times the "
     "scales"},
    {"action.scale_m",
     [](Profile& p) -> Slot {
       return Number{&p.action_scale_m, 100};
     },
     "box and ball: m that 1 stands for"},
    {"action.scale_rad",
     [](Profile& p) -> Slot {
       return Number{&p.action_scale_rad, 100};
     },
     "box and ball: rad that 1 stands for"},
    {"action.rotation", [](Profile& p) -> Slot { return &p.action_rotation; },
     "numbers 4 to 6 of an action, rad: axis times angle, or roll pitch yaw"},
    {"action.gripper", [](Profile& p) -> Slot { return &p.action_gripper; },
     "the last number: -1 closed 1 open, 0 closed 1 open, or the other way round"},
    {"action.threshold", [](Profile& p) -> Slot { return &p.action_threshold; },
     "above it the last number is 1, else the least; none: kept as it is"},
    {"action.sticky", [](Profile& p) -> Slot { return &p.action_sticky; },
     "under `ee_delta_interpolated`: an opening as how far to go, a switch held; against the last "
     "answer, the last switch, half way"},
    {"action.sticky_steps",
     [](Profile& p) -> Slot {
       return Count{&p.action_sticky_steps, kMostActions, ""};
     },
     "for so many steps"},
    {"action.normalised", [](Profile& p) -> Slot { return &p.action_statistics.kind; },
     "how raw answers are to be taken back; servers usually do it themselves"},
    {"action.low", [](Profile& p) -> Slot { return &p.action_statistics.low; },
     "bound: what -1 stands for, as many numbers as an action has"},
    {"action.high", [](Profile& p) -> Slot { return &p.action_statistics.high; },
     "bound: what 1 stands for"},
    {"action.mean", [](Profile& p) -> Slot { return &p.action_statistics.mean; }, "gaussian"},
    {"action.std", [](Profile& p) -> Slot { return &p.action_statistics.std; }, "gaussian"},
    {"action.mask", [](Profile& p) -> Slot { return &p.action_statistics.mask; },
     "1 for a number that is normalised, 0 for one that is not"},
    {"action.limit_m",
     [](Profile& p) -> Slot {
       return Number{&p.action_limit_m, 100};
     },
     "a longer shift in one step is refused"},
    {"action.limit_rad",
     [](Profile& p) -> Slot {
       return Number{&p.action_limit_rad, 1000};
     },
     "a larger turn in one step is refused"},
    {"chunk.length",
     [](Profile& p) -> Slot {
       return Count{&p.chunk_length, kMostActions, "any"};
     },
     "actions of an answer"},
    {"chunk.use",
     [](Profile& p) -> Slot {
       return Count{&p.chunk_use, kMostActions, "all"};
     },
     "of them that are done before the next question"},
    {"ensemble", [](Profile& p) -> Slot { return &p.ensemble; },
     "temporal: a question every step, the mean over all answers"},
    {"ensemble.ratio",
     [](Profile& p) -> Slot {
       return Number{&p.ensemble_ratio, 1000};
     },
     "weight of an answer over that of the one before it"},
    {"arm.joints",
     [](Profile& p) -> Slot {
       return Count{&p.arm_joints, 32, ""};
     },
     "of the arm that `policy test` asks about; `run` asks about its plan's"},
    {"connection", [](Profile& p) -> Slot { return &p.connection; },
     "whether a new one is made for each episode"},
    {"checkpoint", [](Profile& p) -> Slot { return &p.checkpoint; },
     "intact: whether the server loads the one that the address names"},
    {"worlds", [](Profile& p) -> Slot { return &p.worlds; },
     "one: the server keeps something of an episode for all who ask it, so --jobs is 1"},
    {"timeout.wait_s",
     [](Profile& p) -> Slot {
       return Number{&p.wait_s, kLongest};
     },
     "for a server that is not there, trying again"},
    {"timeout.connect_s",
     [](Profile& p) -> Slot {
       return Number{&p.connect_s, kLongest};
     },
     "one attempt"},
    {"timeout.first_s",
     [](Profile& p) -> Slot {
       return Number{&p.first_s, kLongest};
     },
     "a connection's first answer: the server may still compile"},
    {"timeout.answer_s",
     [](Profile& p) -> Slot {
       return Number{&p.answer_s, kLongest};
     },
     "any other answer"},
    {"answer.largest_mib",
     [](Profile& p) -> Slot {
       return Count{&p.largest_answer, 1024, ""};
     },
     "a larger answer is refused"},
    {"dialect", [](Profile& p) -> Slot { return &p.dialect; },
     "gr00t: n1.5, n1.6 or nested; see the protocol"},
    {"unnorm_key", [](Profile& p) -> Slot { return &p.unnorm_key; },
     "openvla: the data set whose statistics the server uses"},
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Words between blanks and commas.
std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t first = text.find_first_not_of(" \t,");
    if (first == std::string_view::npos) return words;
    text.remove_prefix(first);
    const std::size_t size = std::min(text.find_first_of(" \t,"), text.size());
    words.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
}

template <typename T>
std::optional<T> to_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

std::string shortest(double value) {
  char text[40];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

Failure bad(std::string message) { return {Fault::kUsage, std::move(message), ""}; }

std::string found(std::string_view value) { return ", found `" + std::string(value) + "`"; }

// Reads what a slot holds.
struct Reader {
  std::string_view field, value;

  Status operator()(std::string* text) const {
    if (value.empty()) return bad("`" + std::string(field) + "` has no text");
    *text = value;
    return {};
  }
  Status operator()(const Count& count) const {
    if (!count.zero.empty() && value == count.zero) {
      *count.value = 0;
      return {};
    }
    const auto number = to_number<int>(value);
    if (!number || *number < 1 || *number > count.most) {
      const std::string zero = count.zero.empty() ? "" : ", or `" + std::string(count.zero) + "`";
      return bad("`" + std::string(field) + "` is a whole number from 1 to " +
                 std::to_string(count.most) + zero + found(value));
    }
    *count.value = *number;
    return {};
  }
  Status operator()(const Number& slot) const {
    const auto number = to_number<double>(value);
    if (!number || *number <= 0 || *number > slot.most) {
      return bad("`" + std::string(field) + "` is a number above 0, up to " + shortest(slot.most) +
                 found(value));
    }
    *slot.value = *number;
    return {};
  }
  Status operator()(std::optional<double>* slot) const {
    if (value == "none") {
      slot->reset();
      return {};
    }
    const auto number = to_number<double>(value);
    if (!number) return bad("`" + std::string(field) + "` is a number or `none`" + found(value));
    *slot = *number;
    return {};
  }
  Status operator()(std::vector<double>* slot) const {
    slot->clear();
    for (const std::string_view word : split(value)) {
      const auto number = to_number<double>(word);
      if (!number) return bad("`" + std::string(field) + "` is made of numbers" + found(word));
      slot->push_back(*number);
    }
    if (slot->empty() || slot->size() > kMostNumbers) {
      return bad("`" + std::string(field) + "` has " + std::to_string(slot->size()) +
                 " numbers, not 1 to " + std::to_string(kMostNumbers));
    }
    return {};
  }
  Status operator()(std::vector<ImageRule>* slot) const {
    PROBE_ASSIGN(ImageRule rule, read_image());
    for (const ImageRule& other : *slot) {
      if (other.key == rule.key) return bad("two images have the key `" + rule.key + "`");
    }
    slot->push_back(std::move(rule));
    return {};
  }
  Status operator()(std::vector<StateRule>* slot) const {
    const std::vector<std::string_view> words = split(value);
    if (words.size() != 2) return bad("a state is written `KEY LAYOUT`" + found(value));
    StateRule rule{std::string(words[0]), StateLayout::kNone};
    PROBE_TRY(read_word(words[1], field, &rule.layout));
    if (rule.layout == StateLayout::kNone) return bad("a state of layout none is not sent");
    slot->push_back(std::move(rule));
    return {};
  }
  template <typename E>
  Status operator()(E* slot) const {
    return read_word(value, field, slot);
  }

 private:
  template <typename E>
  static Status read_word(std::string_view text, std::string_view field, E* slot) {
    std::vector<std::string> known;
    for (const auto& word : words_of(E{})) {
      if (word.text == text) {
        *slot = word.value;
        return {};
      }
      known.emplace_back(word.text);
    }
    std::string list;
    for (const std::string& word : known) list += (list.empty() ? "" : ", ") + word;
    return bad("`" + std::string(field) + "` is one of " + list + found(text) +
               did_you_mean(text, known));
  }

  Result<ImageRule> read_image() const {
    const std::vector<std::string_view> words = split(value);
    if (words.size() < 3 || words[1] != "->") {
      return bad("an image is written `CAMERA -> KEY [WIDTHxHEIGHT RULE] [jpeg95] [LAYOUT]`" +
                 found(value));
    }
    ImageRule rule;
    if (words[0] != "first") rule.camera = words[0];
    rule.key = words[2];
    bool has_rule = false;
    for (const std::string_view word : std::span(words).subspan(3)) {
      const std::size_t cross = word.find('x');
      if (word.front() >= '0' && word.front() <= '9') {
        const auto width = to_number<int>(word.substr(0, cross));
        const auto height =
            cross == std::string_view::npos ? std::nullopt : to_number<int>(word.substr(cross + 1));
        if (!width || !height || *width < 1 || *height < 1 || *width > kLargestSide ||
            *height > kLargestSide) {
          return bad("a size is written WIDTHxHEIGHT, each from 1 to " +
                     std::to_string(kLargestSide) + found(word));
        }
        rule.width = *width;
        rule.height = *height;
      } else if (word == kThroughJpeg) {
        rule.is_jpeg = true;
      } else if (word == "hwc_u8" || word == "chw_f32") {
        PROBE_TRY(read_word(word, "image", &rule.layout));
      } else {
        PROBE_TRY(read_word(word, "image", &rule.resize));
        has_rule = true;
      }
    }
    if (rule.width > 0 && (!has_rule || rule.resize == Resize::kNone)) {
      return bad("an image of a given size needs one of stretch, pad, crop" + found(value));
    }
    if (rule.width == 0 && has_rule && rule.resize != Resize::kNone) {
      return bad("`" + std::string(word_of(rule.resize)) + "` needs a size, as in 224x224");
    }
    return rule;
  }
};

// Texts that read back equal; an image slot gives a line each.
struct Writer {
  std::vector<std::string> operator()(const std::string* text) const { return {*text}; }
  std::vector<std::string> operator()(const Count& count) const {
    return {*count.value == 0 ? std::string(count.zero) : std::to_string(*count.value)};
  }
  std::vector<std::string> operator()(const Number& number) const {
    return {shortest(*number.value)};
  }
  std::vector<std::string> operator()(const std::optional<double>* number) const {
    return {*number ? shortest(**number) : "none"};
  }
  std::vector<std::string> operator()(const std::vector<double>* numbers) const {
    std::string text;
    for (const double value : *numbers) text += (text.empty() ? "" : " ") + shortest(value);
    return {text};
  }
  std::vector<std::string> operator()(const std::vector<ImageRule>* rules) const {
    std::vector<std::string> lines;
    for (const ImageRule& rule : *rules) {
      std::string line = (rule.camera.empty() ? "first" : rule.camera) + " -> " + rule.key;
      if (rule.width > 0) {
        line += " " + std::to_string(rule.width) + "x" + std::to_string(rule.height) + " " +
                std::string(word_of(rule.resize));
      }
      if (rule.is_jpeg) line += " " + std::string(kThroughJpeg);
      if (rule.layout != PixelLayout::kHwcU8) line += " " + std::string(word_of(rule.layout));
      lines.push_back(std::move(line));
    }
    return lines;
  }
  std::vector<std::string> operator()(const std::vector<StateRule>* rules) const {
    std::vector<std::string> lines;
    for (const StateRule& rule : *rules)
      lines.push_back(rule.key + " " + std::string(word_of(rule.layout)));
    return lines;
  }
  template <typename E>
  std::vector<std::string> operator()(const E* word) const {
    return {std::string(word_of(*word))};
  }
};

// What a field takes, for the help.
struct Takes {
  std::string operator()(std::string*) const { return "text"; }
  std::string operator()(const Count& count) const {
    return "1 .. " + std::to_string(count.most) +
           (count.zero.empty() ? "" : " | " + std::string(count.zero));
  }
  std::string operator()(const Number&) const { return "number"; }
  std::string operator()(std::optional<double>*) const { return "number | none"; }
  std::string operator()(std::vector<double>*) const { return "numbers"; }
  std::string operator()(std::vector<ImageRule>*) const { return "rule"; }
  std::string operator()(std::vector<StateRule>*) const { return "KEY LAYOUT"; }
  template <typename E>
  std::string operator()(E*) const {
    std::string text;
    for (const auto& word : words_of(E{})) {
      text += (text.empty() ? "" : " | ") + std::string(word.text);
    }
    return text;
  }
};

const Field* find_field(std::string_view name) {
  for (const Field& field : kFields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

// A text in quotes without them; `#` begins a comment outside of them.
std::string_view value_of(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('"')) {
    const std::size_t end = text.find('"', 1);
    if (end != std::string_view::npos) return text.substr(1, end - 1);
  }
  return trimmed(text.substr(0, text.find('#')));
}

Failure at(Failure failure, std::string_view where, std::size_t line, std::size_t column) {
  failure.where =
      std::string(where) + ":" + std::to_string(line) + ":" + std::to_string(column + 1);
  return failure;
}

// Of a field's value: line from 1, column from 0.
struct Place {
  std::size_t line = 0, column = 0;
  auto operator<=>(const Place&) const = default;
};

// Statistics have none.
bool has_default(std::string_view field) {
  const Field* known = find_field(field);
  Profile plain;
  if (known == nullptr) return false;
  const auto lines = std::visit(Writer{}, known->slot(plain));
  return !lines.empty() && !lines.front().empty();
}

// At the last of the fields at fault, with those that are not written.
Failure placed(const Mistake& mistake, const std::map<std::string, Place>& places,
               std::string_view where) {
  Failure failure = bad(mistake.message);
  Place last;
  for (const std::string& field : mistake.fields) {
    if (const auto it = places.find(field); it != places.end()) {
      last = std::max(last, it->second);
    } else if (has_default(field)) {
      failure.message += "; `" + field + "` is not written and has its default";
    }
  }
  if (last.line > 0) return at(std::move(failure), where, last.line, last.column);
  failure.where = where;
  return failure;
}

}  // namespace

Status set_field(Profile& profile, std::string_view field, std::string_view value) {
  const Field* known = find_field(field);
  if (known == nullptr) {
    std::vector<std::string> names;
    for (const Field& entry : kFields) names.emplace_back(entry.name);
    return bad("a profile has no field `" + std::string(field) + "`" + did_you_mean(field, names));
  }
  return std::visit(Reader{field, value}, known->slot(profile));
}

Result<Profile> parse_profile(std::string_view text, std::string_view where) {
  Profile profile;
  std::set<std::string_view> seen;
  std::map<std::string, Place> places;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      return at(bad("a line is written `field = value`" + found(trimmed(line))), where, number,
                first);
    }
    const std::string_view field = trimmed(line.substr(0, equals));
    if (field != "image" && field != "state.more" && !seen.insert(field).second) {
      return at(bad("`" + std::string(field) + "` is set twice"), where, number, first);
    }
    const std::string_view value = value_of(line.substr(equals + 1));
    if (auto set = set_field(profile, field, value); !set) {
      const bool names_value = find_field(field) != nullptr && !value.empty();
      const std::size_t column =
          names_value ? static_cast<std::size_t>(value.data() - line.data()) : first;
      return at(set.failure(), where, number, column);
    }
    std::string ordinal;
    if (field == "image") ordinal = " " + std::to_string(profile.images.size());
    if (field == "state.more") ordinal = " " + std::to_string(profile.more_states.size());
    places[std::string(field) + ordinal] = {number,
                                            static_cast<std::size_t>(value.data() - line.data())};
  }
  if (!seen.contains("protocol")) {
    return at(bad("a profile needs a line `protocol = ...`"), where, 1, 0);
  }
  if (const auto mistake = find_mistake(profile)) return placed(*mistake, places, where);
  return profile;
}

std::string to_text(const Profile& profile) {
  Profile shown = profile, plain;
  std::string text;
  for (const Field& field : kFields) {
    const auto lines = std::visit(Writer{}, field.slot(shown));
    if (field.name != "protocol" && lines == std::visit(Writer{}, field.slot(plain))) continue;
    for (const std::string& line : lines) {
      const bool quote = line.find('#') != std::string::npos;
      text += std::string(field.name) + " = " + (quote ? "\"" + line + "\"" : line) + "\n";
    }
  }
  return text;
}

std::string profile_sha256(const Profile& profile) {
  const Profile plain;
  Profile bare = profile;
  bare.about.clear();
  bare.wait_s = plain.wait_s;
  bare.connect_s = plain.connect_s;
  bare.first_s = plain.first_s;
  bare.answer_s = plain.answer_s;
  bare.largest_answer = plain.largest_answer;
  bare.arm_joints = plain.arm_joints;
  return to_hex(sha256(to_text(bare)));
}

std::string profile_help() {
  Profile profile;
  std::string text;
  for (const Field& field : kFields) {
    std::string name = "  " + std::string(field.name);
    name.resize(std::max<std::size_t>(name.size() + 2, 22), ' ');
    text += name + std::visit(Takes{}, field.slot(profile)) + "\n";
    if (!field.meaning.empty()) text += std::string(22, ' ') + std::string(field.meaning) + "\n";
  }
  return text;
}

}  // namespace probe::servers
