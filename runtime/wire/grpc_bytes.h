// Messages as gRPC's core holds them. Private to grpc.cpp and grpc_listener.cpp.
#pragma once

#include <grpc/grpc.h>

#include "runtime/wire/value.h"

namespace probe::wire {

// The core's threads, once for the program; it writes nothing to standard error.
void begin_grpc();

grpc_byte_buffer* grpc_buffer_of(const Bytes& bytes);  // the caller destroys it
Bytes grpc_bytes_of(grpc_byte_buffer* buffer);

}  // namespace probe::wire
