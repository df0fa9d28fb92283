// SPDX-License-Identifier: GPL-2.0-or-later
// Whether VTK can draw.
#pragma once

namespace vielto {

// DISPLAY names an X server that answers. Without one VTK ends the whole program.
bool has_display();

}  // namespace vielto
