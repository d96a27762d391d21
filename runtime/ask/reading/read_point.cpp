// How a point of the picture is read.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {
namespace {

using Point = Reading::Point;

constexpr double kLargest = 1e6;  // pixels; no picture is larger, and no number is used beyond it

std::optional<double> value_of(std::string_view text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  if (!(std::abs(value) <= kLargest)) return std::nullopt;
  return value;
}

Reading pointed(Point point) { return {.verdict = Verdict::kRead, .point = point}; }

// Both within 0 .. 1 with a fraction: shares of the picture, not pixels.
bool is_share(const Point& point) {
  const auto inside = [](double v) { return v >= 0 && v <= 1; };
  const bool whole = point.x == std::floor(point.x) && point.y == std::floor(point.y);
  return inside(point.x) && inside(point.y) && !whole;
}

// All the same, and pixels.
Reading agreed_points(const std::vector<Point>& points) {
  for (const Point& point : points) {
    if (point != points[0]) return unclear();
  }
  return is_share(points[0]) ? unclear() : pointed(points[0]);
}

// ---- marks of models' own ---------------------------------------------------------------------

// <loc0512><loc0256>, y before x in 1,024 steps; four of them are a box.
std::optional<Reading> location_tokens(const ReadContext& context, const AnswerPart& part) {
  constexpr std::string_view kOpen = "<loc";
  constexpr std::size_t kDigits = 4;
  std::vector<double> values;
  for (std::size_t at = part.text.find(kOpen); at != part.text.npos;
       at = part.text.find(kOpen, at + 1)) {
    const std::string_view rest = part.text.substr(at + kOpen.size());
    if (rest.size() <= kDigits || rest[kDigits] != '>') continue;
    const auto value = value_of(rest.substr(0, kDigits));
    if (value) values.push_back(*value);
  }
  if (values.empty()) return std::nullopt;
  if (values.size() != 2 || context.width <= 0 || context.height <= 0) return unclear();
  constexpr double kSteps = 1024;
  // The middle of a step.
  return pointed(
      {(values[1] + 0.5) / kSteps * context.width, (values[0] + 0.5) / kSteps * context.height});
}

// The numbers of attributes such as x="12.3", x1="12.3" of a tag; nothing for others.
void add_attribute(std::string_view tag, std::string_view name, std::vector<double>& out) {
  const std::size_t at = tag.find(name);
  if (at == tag.npos) return;
  std::string_view rest = tag.substr(at + name.size());
  while (!rest.empty() && (rest.front() == '"' || rest.front() == '\'' || rest.front() == ' '))
    rest.remove_prefix(1);
  const std::size_t end = rest.find_first_not_of("0123456789.");
  if (const auto value = value_of(rest.substr(0, end))) out.push_back(*value);
}

std::optional<Reading> point_tag(const ReadContext&, const AnswerPart& part) {
  const std::size_t open = part.text.find("<point");
  if (open == part.text.npos) return std::nullopt;
  const bool again = part.text.find("<point", open + 1) != part.text.npos;
  const std::size_t close = part.text.find('>', open);
  const std::string_view tag = part.text.substr(open, close - open);
  std::vector<double> x, y, more;
  for (const char* name : {" x=", " x1="}) add_attribute(tag, name, x);
  for (const char* name : {" y=", " y1="}) add_attribute(tag, name, y);
  add_attribute(tag, " x2=", more);
  if (again || x.size() != 1 || y.size() != 1 || !more.empty()) return unclear();
  // Percentages and pixels look alike up to here.
  constexpr double kWhole = 100;
  if (x[0] <= kWhole && y[0] <= kWhole) return unclear();
  return pointed({x[0], y[0]});
}

// ---- numbers ----------------------------------------------------------------------------------

struct Coordinate {
  std::size_t first = 0, end = 0;  // tokens, with a sign
  double value = 0;
};

std::vector<Coordinate> coordinates_of(const Tokens& tokens) {
  std::vector<Coordinate> found;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (tokens[at].kind != TokenKind::kNumber) continue;
    const auto value = value_of(tokens[at].text);
    if (!value) continue;
    const bool minus = at > 0 && tokens[at - 1].is_sign('-') &&
                       tokens[at - 1].end == tokens[at].begin &&
                       (at < 2 || tokens[at - 2].kind != TokenKind::kNumber);
    found.push_back({minus ? at - 1 : at, at + 1, minus ? -*value : *value});
  }
  return found;
}

bool is_unit(const Token& token) {
  return token.is("px") || token.is("pixel") || token.is("pixels");
}

// "x=123, y: 45", "X is 123 and Y is 45", {"x": 123, "y": 45}.
std::optional<Reading> labelled(const ReadContext&, const AnswerPart& part) {
  std::vector<double> x, y;
  for (const Coordinate& number : coordinates_of(part.tokens)) {
    std::size_t at = number.first;
    while (at > 0 && (part.tokens[at - 1].is_sign(':') || part.tokens[at - 1].is_sign('=') ||
                      part.tokens[at - 1].is("is") || part.tokens[at - 1].is("coordinate")))
      --at;
    if (at == 0 || at == number.first) continue;
    if (part.tokens[at - 1].is("x")) x.push_back(number.value);
    if (part.tokens[at - 1].is("y")) y.push_back(number.value);
  }
  if (x.empty() && y.empty()) return std::nullopt;
  if (x.size() != y.size()) return unclear();
  std::vector<Point> points;
  for (std::size_t i = 0; i < x.size(); ++i) points.push_back({x[i], y[i]});
  return agreed_points(points);
}

// Whether nothing but a comma, a semicolon or a unit stands between two numbers.
bool is_pair(const Tokens& tokens, const Coordinate& a, const Coordinate& b) {
  for (std::size_t at = a.end; at < b.first; ++at) {
    const Token& token = tokens[at];
    if (!token.is_sign(',') && !token.is_sign(';') && !is_unit(token)) return false;
  }
  return true;
}

// Two numbers in brackets, (123, 45) or [123, 45]; four are a box.
std::optional<Reading> bracketed(const ReadContext&, const AnswerPart& part) {
  const Tokens& tokens = part.tokens;
  const auto numbers = coordinates_of(tokens);
  std::vector<Point> points;
  bool box = false;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && is_pair(tokens, numbers[last], numbers[last + 1])) ++last;
    const std::size_t first = numbers[i].first;
    std::size_t end = numbers[last].end;
    if (end < tokens.size() && is_unit(tokens[end])) ++end;
    const auto is_between = [&](char open, char close) {
      return first > 0 && tokens[first - 1].is_sign(open) && end < tokens.size() &&
             tokens[end].is_sign(close);
    };
    if (is_between('(', ')') || is_between('[', ']') || is_between('<', '>')) {
      if (last == i + 1) points.push_back({numbers[i].value, numbers[last].value});
      box = box || last > i + 1;
    }
    i = last + 1;
  }
  if (box) return unclear();
  if (points.empty()) return std::nullopt;
  return agreed_points(points);
}

std::optional<Reading> refused_point(const ReadContext&, const AnswerPart& part) {
  if (!is_refusal(part.tokens)) return std::nullopt;
  return Reading{.verdict = Verdict::kRefused};
}

// Exactly two numbers, side by side.
std::optional<Reading> bare_pair(const ReadContext&, const AnswerPart& part) {
  const auto numbers = coordinates_of(part.tokens);
  if (numbers.empty()) return std::nullopt;
  if (numbers.size() != 2 || !is_pair(part.tokens, numbers[0], numbers[1])) return unclear();
  const std::size_t end = numbers[1].end;
  if (end < part.tokens.size() && part.tokens[end].is_sign('%')) return unclear();
  return agreed_points({{numbers[0].value, numbers[1].value}});
}

constexpr ReadRule kPointRules[] = {
    {"location tokens", "<loc0512><loc0256>: y and x in 1,024 steps of the picture",
     location_tokens},
    {"point tag", "<point x= y=>, unless both could be percentages", point_tag},
    {"labelled", "x=123, y=45, also as JSON", labelled},
    {"bracketed",
     "(123, 45) or [123, 45]; other points, boxes and shares of the picture are "
     "unclear",
     bracketed},
    {"refused", "words that say that it cannot or will not answer", refused_point},
    {"pair", "two numbers side by side and no others", bare_pair},
};

}  // namespace

std::span<const ReadRule> point_rules() { return kPointRules; }

}  // namespace probe::ask
