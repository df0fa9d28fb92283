// SPDX-License-Identifier: GPL-2.0-or-later
#include "picture/display.h"

#include <X11/Xlib.h>

namespace vielto {

// The connection stays: a virtual server begins anew when its last client leaves, and VTK would come at that moment.
bool has_display() {
  static Display* const display = XOpenDisplay(nullptr);
  return display != nullptr;
}

}  // namespace vielto
