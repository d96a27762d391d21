// What all protocols do with arrays.
#include "runtime/servers/transport.h"

#include <cmath>
#include <set>
#include <string_view>

#include "runtime/base/printable.h"

namespace probe::servers {
namespace {

constexpr std::size_t kMostActions = 1000;

}  // namespace

Result<BatchAnswers> Transport::ask_all(std::span<const Request* const> /*requests*/,
                                        const Deadlines& /*deadlines*/) {
  return bad("this protocol has no batches");
}

Failure of_item(Failure failure, std::size_t index, std::size_t count) {
  failure.message = "item " + std::to_string(index + 1) + " of " + std::to_string(count) +
                    " of a batch: " + failure.message;
  return failure;
}

Status check_batch(std::size_t answers, std::size_t questions) {
  if (answers == questions) return {};
  return bad("a batch of " + std::to_string(questions) + " observations was answered with " +
             std::to_string(answers) + " items: which is whose cannot be said");
}

Result<std::vector<RawAction>> to_actions(const wire::Value& answer, std::size_t size) {
  const std::string each = std::to_string(size);
  const std::string wanted = "expected actions of " + each + " numbers, an array " + each +
                             " or N x " + each + "; got " + wire::describe(answer);
  const std::vector<std::int64_t> shape = wire::shape_of(answer);
  if (shape.empty() || shape.back() != static_cast<std::int64_t>(size)) return bad(wanted);
  for (std::size_t i = 0; i + 2 < shape.size(); ++i) {
    if (shape[i] != 1) return bad(wanted);
  }
  auto numbers = wire::to_numbers(answer);
  if (!numbers) return bad(wanted + " (" + numbers.failure().message + ")");
  const std::size_t count = numbers->size() / size;
  // A list of lists may be ragged: its first row says nothing of the others.
  if (count == 0 || numbers->size() != count * size ||
      (shape.size() > 1 && static_cast<std::int64_t>(count) != shape[shape.size() - 2])) {
    return bad(wanted);
  }
  if (count > kMostActions) {
    return bad("expected at most " + std::to_string(kMostActions) + " actions, got " +
               std::to_string(count));
  }
  std::vector<RawAction> actions(count, RawAction(size));
  for (std::size_t i = 0; i < numbers->size(); ++i) {
    if (!std::isfinite((*numbers)[i])) {
      return bad("number " + std::to_string(i % size + 1) + " of action " +
                 std::to_string(i / size + 1) + " of " + std::to_string(count) + " is " +
                 (std::isnan((*numbers)[i]) ? "not a number" : "infinite"));
    }
    actions[i / size][i % size] = (*numbers)[i];
  }
  return actions;
}

std::string last_lines(std::string_view text) {
  constexpr std::size_t kLines = 3, kLongest = 300;
  std::vector<std::string> lines;
  for (std::size_t end = text.size(); lines.size() < kLines;) {
    const std::size_t cut = end == 0 ? std::string_view::npos : text.rfind('\n', end - 1);
    const std::size_t begin = cut == std::string_view::npos ? 0 : cut + 1;
    std::string line;
    for (const char c : printable(text.substr(begin, end - begin), kLongest)) {
      if (c != ' ' || (!line.empty() && line.back() != ' ')) line += c;
    }
    if (line.ends_with(' ')) line.pop_back();
    if (!line.empty()) lines.insert(lines.begin(), line);
    if (begin == 0) break;
    end = begin - 1;
  }
  std::string joined;
  for (const std::string& line : lines) joined += (joined.empty() ? "" : " | ") + line;
  return joined;
}

Failure answered(std::string message) { return {Fault::kAnswered, std::move(message), ""}; }

Status check_distinct_keys(const wire::Value& request) {
  const auto* map = request.as<wire::Map>();
  if (map == nullptr) return {};
  std::set<std::string_view> seen;
  for (const auto& [key, value] : *map) {
    if (!seen.insert(key).second) {
      return bad("the request has the key `" + key + "` twice: one of the two would not arrive");
    }
    PROBE_TRY(check_distinct_keys(value));
  }
  return {};
}

wire::Array state_array(const Profile& profile, const std::vector<double>& state) {
  const std::vector<std::int64_t> shape{static_cast<std::int64_t>(state.size())};
  return profile.state_type == NumberType::kF32 ? wire::array_f32(shape, state)
                                                : wire::array_f64(shape, state);
}

}  // namespace probe::servers
