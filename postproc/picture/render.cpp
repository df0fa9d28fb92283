// SPDX-License-Identifier: GPL-2.0-or-later
#include "picture/render.h"

#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkWindowToImageFilter.h>

#include <filesystem>
#include <stdexcept>

#include "core/bad_input.h"
#include "picture/display.h"

namespace vielto {

void need_display() {
  if (!has_display())
    throw BadInput("--pictures", 0, "there is no display to draw with", "run the same command under 'xvfb-run -a'");
}

void write_png(vtkRenderWindow* window, const std::string& path) {
  window->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window);
  image->SetInputBufferTypeToRGB();
  image->ReadFrontBufferOff();
  const std::string partial = path + ".partial";
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(image->GetOutputPort());
  writer->SetFileName(partial.c_str());
  writer->Write();
  std::error_code error;
  std::filesystem::rename(partial, path, error);
  if (error) throw std::runtime_error(path + ": cannot be written; check the folder and the space left");
}

}  // namespace vielto
