// Messages in a stream of bytes, as the language server protocol frames them: headers, an empty
// line, so many bytes. Any bytes give messages or mistakes, never an end.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace probe::lsp {

inline constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMaxHeaderBytes = 8192;
// Of a message that is too large the bytes are passed over, unless it says more than that: nobody
// sends them, and what comes next is read as headers.
inline constexpr std::size_t kMaxSkippedBytes = std::size_t{1} << 30;

class FrameReader {
 public:
  struct Frame {
    std::string message;
    std::string mistake;  // empty when there is none; else there is no message
  };

  void add(std::string_view bytes);
  // The next message, or what is wrong with the bytes that were skipped; nothing until more come.
  std::optional<Frame> next();

 private:
  std::optional<Frame> read_headers();

  std::string bytes_;
  std::size_t at_ = 0;       // what lies before is done with
  std::size_t body_ = 0;     // bytes that the message still has to have
  std::size_t skipped_ = 0;  // bytes of a message that is too large
  bool in_body_ = false;
};

// A message with its header.
std::string framed(std::string_view message);

}  // namespace probe::lsp
