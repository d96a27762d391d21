#include "runtime/wire/endpoint.h"

#include <charconv>

namespace probe::wire {
namespace {

Failure bad(std::string_view text, const std::string& what) {
  return {"usage", "`" + std::string(text) + "`: " + what, "--policy"};
}

bool is_port(std::string_view text) {
  unsigned port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port > 0 && port < 65536;
}

// Percent escapes resolved; nothing on a half one.
Result<std::string> decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() < 2 || error != std::errc() || end != digits.data() + 2) {
      return Failure{"usage", "`%` is not followed by two hexadecimal digits", "--policy"};
    }
    plain += static_cast<char>(byte);
    i += 2;
  }
  return plain;
}

Status read_options(std::string_view text, std::map<std::string, std::string>* options) {
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return bad(pair, "an option is written `name=value`");
    }
    PROBE_ASSIGN(std::string value, decoded(pair.substr(equals + 1)));
    if (!options->emplace(pair.substr(0, equals), std::move(value)).second) {
      return bad(pair, "the option is there twice");
    }
  }
  return {};
}

}  // namespace

Result<Endpoint> parse_endpoint(std::string_view text, std::string_view default_port) {
  if (!text.starts_with("//")) return bad(text, "a server is written `//HOST:PORT`");
  std::string_view rest = text.substr(2);
  Endpoint endpoint;
  const std::size_t query = rest.find('?');
  if (query != std::string_view::npos) {
    PROBE_TRY(read_options(rest.substr(query + 1), &endpoint.options));
    rest = rest.substr(0, query);
  }
  const std::size_t slash = rest.find('/');
  if (slash != std::string_view::npos) {
    endpoint.path = std::string(rest.substr(slash));
    rest = rest.substr(0, slash);
  }
  std::string_view port = default_port;
  const std::size_t bracket = rest.starts_with('[') ? rest.find(']') : 0;
  if (bracket == std::string_view::npos) return bad(text, "a bracket is not closed");
  const std::size_t colon = rest.find(':', bracket);
  if (colon != std::string_view::npos) port = rest.substr(colon + 1);
  std::string_view host = rest.substr(0, colon);
  if (bracket > 0) host = host.substr(1, bracket - 1);
  if (host.empty()) return bad(text, "a host is missing");
  if (!is_port(port)) return bad(text, "`" + std::string(port) + "` is no port from 1 to 65535");
  endpoint.host = std::string(host);
  endpoint.port = std::string(port);
  return endpoint;
}

}  // namespace probe::wire
