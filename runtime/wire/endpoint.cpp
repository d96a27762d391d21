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

// Whatever stands in a policy's name gets into results and reports.
bool is_secret(std::string_view option) {
  std::string name;
  for (const char c : option) {
    if (c != '_' && c != '-' && c != '.')
      name += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  }
  for (const char* known : {"key", "apikey", "token", "apitoken", "accesstoken", "auth",
                            "authorization", "password", "passwd", "secret", "bearer"}) {
    if (name == known) return true;
  }
  return false;
}

Failure secret(const std::string& what) {
  return {"usage",
          what +
              " would be stored with every result: give it in the environment, as "
              "VLAPROBE_API_KEY",
          "--policy"};
}

Status read_options(std::string_view text, std::map<std::string, std::string>* options) {
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return bad(pair, "an option is written `name=value`");
    }
    if (is_secret(pair.substr(0, equals))) {
      return secret("a secret, `" + std::string(pair.substr(0, equals)) + "`,");
    }
    PROBE_ASSIGN(std::string value, decoded(pair.substr(equals + 1)));
    if (!options->emplace(pair.substr(0, equals), std::move(value)).second) {
      return bad(pair.substr(0, equals), "the option is there twice");
    }
  }
  return {};
}

}  // namespace

Result<Endpoint> parse_endpoint(std::string_view text, std::string_view default_port) {
  const std::size_t query = text.find('?');
  const std::string_view options =
      query == std::string_view::npos ? std::string_view() : text.substr(query + 1);
  text = text.substr(0, query);
  if (!text.starts_with("//")) return bad(text, "a server is written `//HOST:PORT`");
  for (const char c : text) {
    // They would end a line of an HTTP request.
    if (static_cast<unsigned char>(c) <= 0x20 || c == 0x7f) {
      return Failure{"usage", "a server's address has a blank or a control character; write %20",
                     "--policy"};
    }
  }
  std::string_view rest = text.substr(2);
  Endpoint endpoint;
  PROBE_TRY(read_options(options, &endpoint.options));
  if (rest.substr(0, rest.find('/')).find('@') != std::string_view::npos) {
    return secret("a name or a password before `@`");
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
