// Opening a connection to a server that may not be there yet, and what failures say to people.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"

namespace probe::servers {

wire::Duration to_duration(double seconds);

// The failure at `server` (HOST:PORT), kAnswered as kPolicy, without the API key: it is stored.
Failure named(Failure failure, const std::string& server);

// What transport.open() and adapt() do, tried again with growing pauses until `given.wait_s` have
// passed. A server that answers with an error is there: that fails at once, and so does what
// profile and server do not agree on (kUsage). `adapted` is `given` as the server wants it. Out:
// how many attempts it took; after more than one, whoever answers may be another than before.
Result<int> open_patiently(Transport& transport, const Profile& given, const std::string& server,
                           Profile* adapted);

}  // namespace probe::servers
