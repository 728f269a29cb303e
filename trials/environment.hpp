// Where a result came from: versions, processor, renderer; and the pinned environment that makes it repeatable.
#pragma once

#include <string>

namespace binpick {

/// Hash of this program's file: two builds of it are two programs, whatever their sources.
std::string build_id();
std::string environment_json(const std::string& renderer);

/// The libraries' hidden processor dispatch (libm's FMA variants, the software renderer's instruction sets) changes
/// last bits from machine to machine. It can only be pinned before a program starts: when the pins are not in place,
/// sets them and starts this program anew with the same arguments. Returns when they are.
void pin_environment(char** argv);

}  // namespace binpick
