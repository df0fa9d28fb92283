// SPDX-License-Identifier: GPL-2.0-or-later
#include "picture/display.h"

#include <X11/Xlib.h>

namespace vielto {

bool has_display() {
  Display* display = XOpenDisplay(nullptr);
  if (!display) return false;
  XCloseDisplay(display);
  return true;
}

}  // namespace vielto
