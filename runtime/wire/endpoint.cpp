#include "runtime/wire/endpoint.h"

#include <charconv>

namespace probe::wire {
namespace {

Failure bad(std::string_view text, const std::string& what) {
  return {Fault::kUsage, "`" + std::string(text) + "`: " + what, "--policy"};
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
      return Failure{Fault::kUsage, "`%` is not followed by two hexadecimal digits", "--policy"};
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
  for (const char* known :
       {"key", "auth", "authorization", "bearer", "pass", "pwd", "sig", "sas", "jwt", "pat"}) {
    if (name == known) return true;
  }
  for (const char* end : {"apikey", "token", "tok", "sas", "signature", "privatekey"}) {
    if (name.ends_with(end)) return true;
  }
  for (const char* part : {"accesskey", "secret", "password", "passwd", "credential"}) {
    if (name.find(part) != std::string::npos) return true;
  }
  return false;
}

// The same of a URL that an option's value is, or has in it: other services have other names.
bool is_secret_of_url(std::string_view option) {
  if (is_secret(option)) return true;
  std::string name;
  for (const char c : option) name += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return name == "code" || name == "sk" || name.ends_with("key");
}

Failure secret(const std::string& what) {
  return {Fault::kUsage,
          what +
              " would be stored with every result: give it in the environment, as "
              "VLAPROBE_API_KEY",
          "--policy"};
}

// Of a URL's authority: what stands before the `@` is a name and a password.
bool has_user(std::string_view text) {
  for (std::size_t at = text.starts_with("//") ? 0 : text.find("://"); at != std::string_view::npos;
       at = text.find("://", at + 1)) {
    const std::string_view rest = text.substr(text.find("//", at) + 2);
    if (rest.substr(0, rest.find_first_of("/?#")).find('@') != std::string_view::npos) return true;
  }
  return false;
}

// A secret inside a value: in a URL that is one, or in an address's options. `what` names the
// value in the message, which never shows it.
Status check_no_secret(const std::string& what, std::string value) {
  constexpr int kDeepest = 4;  // a URL in a URL is escaped once more
  constexpr std::string_view kBetween = "?&;#, \t";
  for (int depth = 0; depth < kDeepest; ++depth) {
    if (has_user(value)) return secret("a name or a password before `@` in " + what);
    std::string_view rest = value;
    while (!rest.empty()) {
      const std::string_view part = rest.substr(0, rest.find_first_of(kBetween));
      rest.remove_prefix(std::min(rest.size(), part.size() + 1));
      const std::size_t equals = part.find('=');
      if (equals == std::string_view::npos || !is_secret_of_url(part.substr(0, equals))) continue;
      return secret("a secret, `" + std::string(part.substr(0, equals)) + "`, in " + what);
    }
    auto plain = decoded(value);
    if (!plain || *plain == value) break;
    value = std::move(*plain);
  }
  return {};
}

Status read_options(std::string_view text, std::map<std::string, std::string>* options) {
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      // Not shown: it may be the rest of a password with `&`.
      return Failure{Fault::kUsage,
                     "option " + std::to_string(number) + " of the address is not `name=value`",
                     "--policy"};
    }
    if (pair.substr(0, equals).find('%') != std::string_view::npos) {
      // Not shown: an escaped `=` may stand between a name and a secret.
      return Failure{Fault::kUsage,
                     "option " + std::to_string(number) + " of the address has `%` in its name",
                     "--policy"};
    }
    if (is_secret(pair.substr(0, equals))) {
      return secret("a secret, `" + std::string(pair.substr(0, equals)) + "`,");
    }
    PROBE_ASSIGN(std::string value, decoded(pair.substr(equals + 1)));
    PROBE_TRY(check_no_secret("`" + std::string(pair.substr(0, equals)) + "`,", value));
    if (!options->emplace(pair.substr(0, equals), std::move(value)).second) {
      return bad(pair.substr(0, equals), "the option is there twice");
    }
  }
  return {};
}

}  // namespace

std::string Endpoint::authority() const {
  const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
  return port == (tls.is_on ? "443" : "80") ? name : name + ":" + port;
}

Result<Endpoint> parse_endpoint(std::string_view text, std::string_view default_port) {
  const std::size_t query = text.find('?');
  const std::string_view options =
      query == std::string_view::npos ? std::string_view() : text.substr(query + 1);
  text = text.substr(0, query);
  if (!text.starts_with("//")) {
    if (text.find('@') != std::string_view::npos) return secret("a name or a password before `@`");
    return bad(text, "a server is written `//HOST:PORT`");
  }
  for (const char c : text) {
    // They would end a line of an HTTP request.
    if (static_cast<unsigned char>(c) <= 0x20 || c == 0x7f) {
      return Failure{Fault::kUsage,
                     "a server's address has a blank or a control character; write %20",
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
    PROBE_TRY(check_no_secret("the path,", endpoint.path));
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
