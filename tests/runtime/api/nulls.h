/* Exits with 1, having said where, when a NULL is not refused by name. `file` is a plan's. */
#pragma once

#include "vlaprobe.h"

void nulls(vlaprobe_plan* plan, size_t task, const char* file);
