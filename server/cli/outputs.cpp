#include "server/cli/outputs.h"

#include "server/cli/command.h"

namespace translucube::server {

namespace fs = std::filesystem;

std::vector<Output> checked_outputs(const std::vector<fs::path>& names,
                                    const DisplayChoice& display, const ColorConfig& colors,
                                    OutputFiles& files) {
  std::vector<Output> outputs;
  bool for_display = false;
  for (const fs::path& file : names) {
    const auto format = format_of(file);
    if (!format)
      throw Refusal{exit_bad_request, file.string() + ": must end in " +
                                          list_formats(&ImageFormatRow::extension, " or ") + '\n'};
    files.writes(file);
    ImageQuery query{*format, {}, {}, {}};
    if (row_of(*format).library == ImageLibrary::open_image_io) prepare_image_codecs();
    if (!is_scene_linear(*format)) {
      for_display = true;
      query.display = display.display;
      query.view = display.view;
    }
    const auto form = image_form(query, colors.displays());
    if (!form) {
      std::string message;
      for (const api::Fault& fault : form.problem().faults)
        message += "--" + fault.pointer.substr(1) + ": " + fault.detail + '\n';
      throw Refusal{exit_bad_request, message};
    }
    outputs.push_back({file, *form});
  }
  if ((display.display || display.view) && !for_display)
    throw Refusal{exit_bad_request, "--display and --view are for " +
                                        list_display_formats(&ImageFormatRow::title, " and ") +
                                        " outputs\n"};
  return outputs;
}

void write_outputs(const std::vector<Output>& outputs, const Image& picture,
                   const ColorConfig& colors, const std::string& canonical_request,
                   OutputFiles& files) {
  for (const Output& output : outputs)
    files.write(output.file, [&](const fs::path& temporary) {
      write_form(temporary, picture, output.form, colors, canonical_request);
    });
}

}  // namespace translucube::server
