// SPDX-License-Identifier: GPL-2.0-or-later
// What the pictures share. They are drawn with VTK into PNG files; VTK needs a display, even to draw into a file.
#pragma once

#include <string>

class vtkRenderWindow;

namespace vielto {

// Errors: BadInput if there is no display (VTK would abort the program).
void need_display();

// Renders off screen and writes PATH.partial, then renames it.
// Errors: std::runtime_error if the file cannot be written.
void write_png(vtkRenderWindow* window, const std::string& path);

}  // namespace vielto
