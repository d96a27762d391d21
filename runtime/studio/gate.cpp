#include "runtime/studio/gate.h"

#include <sys/random.h>

#include <array>
#include <cstdint>

namespace probe::studio {
namespace {

wire::Page no(int status, std::string why) {
  return {status, "text/plain; charset=utf-8", "vlaprobe studio: " + why + "\n", {}};
}

// In a time that does not depend on where they differ.
bool is_equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return different == 0;
}

std::string_view without_query(std::string_view target) {
  return target.substr(0, std::min(target.find_first_of("?#"), target.size()));
}

}  // namespace

std::optional<wire::Page> Gate::refuse(const wire::Visit& visit) const {
  const std::string hosts[] = {"127.0.0.1:" + port, "localhost:" + port};
  const auto is_ours = [&](std::string_view host) { return host == hosts[0] || host == hosts[1]; };
  if (!is_ours(visit.host))
    return no(421, "asked as another machine's; it answers to " + hosts[0] + " alone");
  constexpr std::string_view kScheme = "http://";
  const bool is_foreign =
      !visit.origin.empty() && (!visit.origin.starts_with(kScheme) ||
                                !is_ours(std::string_view(visit.origin).substr(kScheme.size())));
  // "none" is somebody who typed the address or followed a link from no page.
  const bool is_elsewhere =
      !visit.site.empty() && visit.site != "same-origin" && visit.site != "none";
  if (is_foreign || (visit.is_upgrade && is_elsewhere))
    return no(403, "asked by a page of another origin");
  const std::string_view target = without_query(visit.target);
  const std::size_t end = target.find('/', 1);
  const std::string_view first = target.substr(std::min<std::size_t>(1, target.size()),
                                               end == target.npos ? target.npos : end - 1);
  if (!target.starts_with('/') || !is_equal(first, token)) {
    return no(403,
              "the token is missing or another one's. Open the whole address that the program "
              "printed");
  }
  if (visit.method != "GET" && visit.method != "HEAD") return no(405, "only GET is answered");
  return std::nullopt;
}

std::string_view Gate::path(std::string_view target) const {
  std::string_view rest = without_query(target);
  rest.remove_prefix(std::min(rest.size(), token.size() + 1));
  if (rest.starts_with('/')) rest.remove_prefix(1);
  return rest;
}

Result<std::string> make_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return Failure{Fault::kIo, "the system gives no random numbers", "getrandom"};
  constexpr char kDigits[] = "0123456789abcdef";
  std::string token;
  for (const std::uint8_t byte : bytes) token += {kDigits[byte >> 4], kDigits[byte & 15]};
  return token;
}

}  // namespace probe::studio
