// SPDX-License-Identifier: GPL-2.0-or-later
// What the pictures share.
#pragma once

#include <string>

class vtkRenderWindow;

namespace vielto {

// Renders off screen and writes PATH.partial, then renames it.
// Errors: std::runtime_error if the file cannot be written.
void write_png(vtkRenderWindow* window, const std::string& path);

}  // namespace vielto
