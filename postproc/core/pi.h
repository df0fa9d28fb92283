// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace vielto {

constexpr double kPi = 3.14159265358979323846;

}  // namespace vielto
