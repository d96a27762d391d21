#include "runtime/ask/reading/likely_letters.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace probe::ask {
namespace {

// Tokens of models whose vocabulary has marks for blanks.
std::string without_blank_marks(std::string_view token) {
  constexpr std::pair<std::string_view, char> kMarks[] = {
      {"\xe2\x96\x81", ' '}, {"\xc4\xa0", ' '}, {"\xc4\x8a", '\n'}};
  std::string out;
  while (!token.empty()) {
    const auto mark =
        std::ranges::find_if(kMarks, [&](const auto& one) { return token.starts_with(one.first); });
    const bool is_mark = mark != std::end(kMarks);
    out += is_mark ? mark->second : token[0];
    token.remove_prefix(is_mark ? mark->first.size() : 1);
  }
  return out;
}

// Where in the token its one letter stands, if blanks and signs are all it has beside.
std::optional<std::size_t> letter_in(std::string_view token) {
  constexpr std::string_view kAround = " \n\t\r*_`\"'()[]{}<>$.:,;";
  const std::size_t at = token.find_first_not_of(kAround);
  if (at == token.npos || token[at] < 'A' || token[at] > 'Z') return std::nullopt;
  if (token.find_first_not_of(kAround, at + 1) != token.npos) return std::nullopt;
  return at;
}

const Json* table_of(const Json* logprobs) {
  const Json* content =
      logprobs == nullptr || !logprobs->is_object() ? nullptr : logprobs->find("content");
  return content == nullptr || !content->is_array() || content->empty() ? nullptr : content;
}

std::optional<std::string> token_of(const Json& entry) {
  const Json* token = entry.is_object() ? entry.find("token") : nullptr;
  if (token == nullptr || !token->is_string()) return std::nullopt;
  return without_blank_marks(token->text());
}

// By letter, or empty where the list is junk or has no letter.
std::vector<std::optional<double>> letters_of_list(const Json* top, std::size_t letters) {
  if (top == nullptr || !top->is_array()) return {};
  std::vector<std::optional<double>> found(letters);
  std::set<std::string_view> seen;
  bool any = false;
  for (const Json& entry : *top) {
    const auto token = token_of(entry);
    const Json* logprob = token ? entry.find("logprob") : nullptr;
    if (logprob == nullptr || !logprob->is_number()) return {};
    const double value = logprob->get<double>();
    if (!is_logprob(value)) return {};
    if (!seen.insert(entry.find("token")->text()).second) return {};
    const auto letter = letter_in(*token);
    if (!letter) continue;
    const auto place = static_cast<std::size_t>((*token)[*letter] - 'A');
    if (place >= letters) continue;
    std::optional<double>& at = found[place];
    const double high = at ? std::max(*at, value) : value;
    at = at ? high + std::log1p(std::exp(std::min(*at, value) - high)) : value;
    any = true;
  }
  if (!any) return {};
  return found;
}

}  // namespace

bool is_logprob(double value) {
  constexpr double kRounding = 1e-3;
  return std::isfinite(value) && value <= kRounding;
}

bool tells_logprobs(const Json* logprobs) {
  const Json* table = table_of(logprobs);
  if (table == nullptr || !table->front().is_object()) return false;
  const Json* top = table->front().find("top_logprobs");
  return top != nullptr && top->is_array() && !top->empty();
}

std::vector<WrittenLetter> written_letters(const Json* logprobs, std::string_view raw,
                                           std::size_t letters) {
  const Json* table = table_of(logprobs);
  if (table == nullptr || letters == 0 || raw.empty()) return {};
  std::string said;
  std::vector<std::pair<std::size_t, const Json*>> found;  // where in `said` a letter stands
  for (const Json& entry : *table) {
    const auto token = token_of(entry);
    if (!token) break;  // what follows stands nobody knows where
    if (const auto letter = letter_in(*token)) found.emplace_back(said.size() + *letter, &entry);
    said += *token;
  }
  // Thoughts that are given apart have tokens, too, and blanks at the ends may be left out; or the
  // server tells the first tokens alone.
  std::size_t begin = said.rfind(raw);
  if (begin == said.npos) {
    if (said.empty() || !raw.starts_with(said)) return {};
    begin = 0;
  }
  std::vector<WrittenLetter> out;
  for (const auto& [at, entry] : found) {
    if (at < begin || at - begin >= raw.size()) continue;
    const auto place = static_cast<std::size_t>(said[at] - 'A');
    auto logs = letters_of_list(entry->find("top_logprobs"), letters);
    if (place < letters) out.push_back({place, at - begin, std::move(logs)});
  }
  return out;
}

std::vector<std::optional<double>> at_read_letter(const AnswerReader& reader,
                                                  std::span<const WrittenLetter> written,
                                                  std::string_view raw, std::string_view finish,
                                                  const Reading& reading) {
  constexpr int kMost = 20;  // letters; nobody takes so long to say which
  const auto& options = reader.context().options;
  const std::size_t colon = reading.rule.rfind(": ");
  const auto rule =
      std::string_view(reading.rule).substr(colon == std::string::npos ? 0 : colon + 2);
  if (!reading.option || options.size() < 2 || !rule.starts_with("letter")) return {};
  int tried = 0;
  for (const WrittenLetter& letter : written) {
    if (letter.begin >= raw.size()) break;
    if (letter.place >= options.size() || options[letter.place].option != reading.option) continue;
    if (++tried > kMost) break;
    std::string other(raw);
    other[letter.begin] = static_cast<char>('A' + (letter.place + 1) % options.size());
    if (reader.read(other, finish) != reading) return letter.logprobs;
  }
  return {};
}

}  // namespace probe::ask
