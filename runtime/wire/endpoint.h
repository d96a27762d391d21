// Where a policy server is: what stands after the protocol in
// `openpi://HOST:PORT/path?key=value&key=value`.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe::wire {

// Whether bytes go through TLS, and whose certificates are taken.
struct Tls {
  bool is_on = false;
  // PEM file of the authorities that are trusted; empty: the system's, or SSL_CERT_FILE's.
  std::string authorities = {};
  bool accepts_any = false;  // neither signature nor host name is checked
};

struct Endpoint {
  std::string host;
  std::string port;
  std::string path = "/";
  std::map<std::string, std::string> options;  // percent-decoded
  Tls tls = {};

  std::string name() const {
    return host + ":" + port;
  }  // for messages: without options, which may be private

  // As HTTP's field Host has it: an IPv6 address in brackets, no port that goes without saying.
  std::string authority() const;
};

// `text` begins with "//". A missing port is `default_port`; a host in brackets is an IPv6 address.
// Fails (kUsage, place "--policy") naming what is missing or twice there, and on whatever
// looks like a secret: an option or a parameter inside an option's value with such a name, a name
// or a password in a URL. No message shows it.
Result<Endpoint> parse_endpoint(std::string_view text, std::string_view default_port);

}  // namespace probe::wire
