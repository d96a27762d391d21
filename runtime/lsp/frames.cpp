#include "runtime/lsp/frames.h"

#include <algorithm>
#include <charconv>
#include <cctype>

namespace probe::lsp {
namespace {

bool is_same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

}  // namespace

void FrameReader::add(std::string_view bytes) {
  if (at_ > 0 && at_ >= bytes_.size() / 2) {
    bytes_.erase(0, at_);
    at_ = 0;
  }
  const std::size_t drop = std::min(skipped_, bytes.size());
  skipped_ -= drop;
  bytes_ += bytes.substr(drop);
}

std::optional<FrameReader::Frame> FrameReader::read_headers() {
  const std::string_view rest = std::string_view(bytes_).substr(at_);
  std::optional<std::size_t> length;
  std::string mistake;
  std::size_t at = 0;
  while (true) {
    const std::size_t end = rest.find('\n', at);
    if (end == rest.npos || end > kMaxHeaderBytes) {
      if (rest.size() <= kMaxHeaderBytes) return std::nullopt;
      // Nothing of it can be a message; what follows the next line may be one.
      at_ += end == rest.npos ? rest.size() : end + 1;
      return Frame{"", "expected a header `Content-Length: N`, found a line of other bytes"};
    }
    const std::string_view line = trimmed(rest.substr(at, end - at));
    at = end + 1;
    if (line.empty()) break;
    const std::size_t colon = line.find(':');
    if (colon == line.npos) {
      mistake = "expected a header `Content-Length: N`";
      continue;
    }
    if (!is_same_word(trimmed(line.substr(0, colon)), "content-length")) continue;
    const std::string_view value = trimmed(line.substr(colon + 1));
    std::size_t number = 0;
    const auto [last, error] =
        std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || last != value.data() + value.size()) {
      mistake = "the Content-Length is no number of bytes";
    } else {
      length = number;
    }
  }
  at_ += at;
  if (!length) return Frame{"", mistake.empty() ? "a header without Content-Length" : mistake};
  if (*length > kMaxSkippedBytes)
    return Frame{"", "a message of more than 1 GiB, which nobody sends"};
  if (*length > kMaxMessageBytes) {
    const std::size_t here = std::min(*length, bytes_.size() - at_);
    at_ += here;
    skipped_ = *length - here;
    return Frame{"", "a message of more than 64 MiB"};
  }
  body_ = *length;
  in_body_ = true;
  return std::nullopt;
}

std::optional<FrameReader::Frame> FrameReader::next() {
  if (!in_body_) {
    if (auto mistake = read_headers()) return mistake;
    if (!in_body_) return std::nullopt;
  }
  if (bytes_.size() - at_ < body_) return std::nullopt;
  Frame frame{bytes_.substr(at_, body_), ""};
  at_ += body_;
  in_body_ = false;
  return frame;
}

std::string framed(std::string_view message) {
  return "Content-Length: " + std::to_string(message.size()) + "\r\n\r\n" + std::string(message);
}

}  // namespace probe::lsp
