#include "runtime/export/dataset/wordings.h"

#include "runtime/base/file.h"
#include "runtime/base/hash_number.h"
#include "runtime/base/json.h"
#include "runtime/base/sha256.h"
#include "runtime/policy/policy.h"

namespace probe::dataset {

Result<Wordings> Wordings::read(const std::string& path) {
  PROBE_ASSIGN(const std::string text, read_file(path));
  Wordings out;
  out.sha256_ = to_hex(probe::sha256(std::string_view(text)));
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.empty()) continue;
    const Json json = Json::parse(line);
    const auto is_text = [&](const char* key) {
      return json.contains(key) && json.at(key).is_string();
    };
    const auto is_share = [&](const char* key) {
      return json.contains(key) && json.at(key).is_number() && json.at(key).get<double>() >= 0 &&
             json.at(key).get<double>() <= 1;
    };
    if (!is_text("task") || !is_text("original") || !is_text("wording") || !is_text("split") ||
        !is_share("probability") || !is_share("original_probability"))
      return Failure{Fault::kUsage, "is no line of `vlaprobe rephrase -o X.jsonl`",
                     path + ":" + std::to_string(number)};
    if (!is_text("starts_sha256"))
      return Failure{
          Fault::kUsage,
          "does not say for which starts its words are proved (`starts_sha256`): an older "
          "program wrote it; `vlaprobe rephrase` makes it again",
          path + ":" + std::to_string(number)};
    for (const char* key : {"original", "wording"}) {
      const std::string told = std::string(key) + "_sha256";
      if (is_text(told.c_str()) &&
          json.at(told).text() != to_hex(probe::sha256(std::string_view(json.at(key).text()))))
        return Failure{
            Fault::kUsage,
            "`" + std::string(key) + "` is not what was proved: it has another `" + told + "`",
            path + ":" + std::to_string(number)};
    }
    if (json.at("split").text() != "train") continue;
    const std::string& original = json.at("original").text();
    auto& choices =
        out.choices_[{json.at("task").text(), original, json.at("starts_sha256").text()}];
    if (choices.empty())
      choices.push_back({original, json.at("original_probability").get<double>()});
    choices.push_back({json.at("wording").text(), json.at("probability").get<double>()});
  }
  if (out.choices_.empty())
    return Failure{Fault::kUsage, "has no wordings of the split `train`", path};
  return out;
}

bool Wordings::has(const Told& told) const { return choices_.contains(told); }

bool Wordings::has_for_other_starts(const Told& told) const {
  const auto first = choices_.lower_bound({told.task, told.instruction, ""});
  return !has(told) && first != choices_.end() && first->first.task == told.task &&
         first->first.instruction == told.instruction;
}

std::vector<std::string> Wordings::draw(const Told& told, int count, std::string_view key) const {
  const auto found = choices_.find(told);
  if (found == choices_.end()) return {told.instruction};
  std::vector<Choice> left = found->second;
  policy::Draws draws(little_endian_number(Hasher().text("wordings").text(key).finish()));
  std::vector<std::string> drawn;
  while (!left.empty() && drawn.size() < static_cast<std::size_t>(count)) {
    double sum = 0;
    for (const Choice& choice : left) sum += choice.probability;
    double at = draws.uniform() * sum;
    std::size_t chosen = 0;
    while (chosen + 1 < left.size() && at >= left[chosen].probability)
      at -= left[chosen++].probability;
    drawn.push_back(left[chosen].text);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
  return drawn;
}

}  // namespace probe::dataset
