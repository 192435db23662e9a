#include "report/drawing/render.h"

#include <cairo-pdf.h>
#include <cairo.h>
#include <librsvg/rsvg.h>
#include <png.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/errors.h"

namespace ttf::report::drawing {
namespace {

constexpr double kPngSharpWidth = 2600;   // up to this many CSS pixels a PNG has two for each
constexpr double kPrinted = 300.0 / 96;   // pixels of a PNG for paper for each CSS pixel
constexpr double kPointsPerPixel = 0.75;  // 72 / 96

struct SurfaceFree {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};
struct CairoFree {
  void operator()(cairo_t* c) const { cairo_destroy(c); }
};
struct HandleFree {
  void operator()(RsvgHandle* h) const { g_object_unref(h); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceFree>;
using Cairo = std::unique_ptr<cairo_t, CairoFree>;
using Handle = std::unique_ptr<RsvgHandle, HandleFree>;

enum class Format { kSvg, kPng, kPdf };

[[noreturn]] void fail(const std::string& path, std::string key, std::string value, std::string expected) {
  throw InputError(Finding{path, 0, std::move(key), std::move(value), std::move(expected)});
}

// Reports a failure that is not the input's fault.
[[noreturn]] void fail_to_write(const std::string& path, const std::string& reason = "") {
  throw std::runtime_error(path + ": cannot be written" + (reason.empty() ? "" : ": " + reason));
}

Format format_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t dot = path.find_last_of('.');
  const bool has = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  const std::string extension = has ? path.substr(dot) : "";
  if (extension == ".svg") return Format::kSvg;
  if (extension == ".png") return Format::kPng;
  if (extension == ".pdf") return Format::kPdf;
  fail(path, "file extension", extension.empty() ? "none" : extension, "must be .svg, .png or .pdf");
}

std::string take(GError* error) {
  std::string message = error != nullptr ? error->message : "unknown reason";
  if (error != nullptr) g_error_free(error);
  return message;
}

bool on_paper(RsvgHandle* handle) {
  gboolean has_width = 0, has_height = 0, has_view = 0;
  RsvgLength width{}, height{};
  RsvgRectangle view{};
  rsvg_handle_get_intrinsic_dimensions(handle, &has_width, &width, &has_height, &height, &has_view, &view);
  return has_width != 0 && width.unit != RSVG_UNIT_PX;
}

void draw(RsvgHandle* handle, cairo_surface_t* surface, double scale, double width, double height,
          const std::string& path) {
  const Cairo cairo(cairo_create(surface));
  cairo_scale(cairo.get(), scale, scale);
  const RsvgRectangle viewport{0, 0, width, height};
  GError* error = nullptr;
  if (rsvg_handle_render_document(handle, cairo.get(), &viewport, &error) == 0)
    fail(path, "picture", "", "could not be drawn: " + take(error));
  cairo_show_page(cairo.get());
  cairo_surface_finish(surface);
  // The drawing succeeded; only writing to disk can have failed.
  if (const cairo_status_t status = cairo_surface_status(surface); status != CAIRO_STATUS_SUCCESS)
    fail_to_write(path, cairo_status_to_string(status));
}

// cairo_surface_write_to_png() filters rows and compresses best: five times the time, for files that are smaller by a third
// at most.
void write_png(cairo_surface_t* surface, const std::string& path) {
  cairo_surface_flush(surface);
  const int width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
  const unsigned char* row = cairo_image_surface_get_data(surface);
  std::vector<png_byte> colours(std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  png_byte* colour = colours.data();
  for (int y = 0; y < height; ++y, row += cairo_image_surface_get_stride(surface))
    for (int x = 0; x < width; ++x) {
      std::uint32_t pixel = 0;  // red, green and blue from its third byte down
      std::memcpy(&pixel, row + sizeof pixel * static_cast<std::size_t>(x), sizeof pixel);
      for (const int shift : {16, 8, 0}) *colour++ = static_cast<png_byte>(pixel >> shift);
    }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  if (png_image_write_to_file(&image, path.c_str(), 0, colours.data(), 0, nullptr) == 0)
    fail_to_write(path, image.message);
}

}  // namespace

void check_picture_path(const std::string& path) { format_of(path); }

void write_picture(const std::string& svg, const std::string& path) {
  const Format format = format_of(path);
  if (format == Format::kSvg) {
    std::ofstream out(path, std::ios::binary);
    out << svg;
    out.close();
    if (!out) fail_to_write(path);
    return;
  }
  GError* error = nullptr;
  const Handle handle(rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!handle) fail(path, "picture", "", "is not valid SVG: " + take(error));
  rsvg_handle_set_dpi(handle.get(), 96);
  double width = 0, height = 0;
  if (rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width, &height) == 0 || width < 1 || height < 1)
    fail(path, "picture", "", "has no size");

  if (format == Format::kPng) {
    const double scale = on_paper(handle.get()) ? kPrinted : width <= kPngSharpWidth ? 2 : 1;
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width * scale + 1e-6),
                                                     static_cast<int>(height * scale + 1e-6)));
    if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
      fail_to_write(path, cairo_status_to_string(status));
    const Cairo cairo(cairo_create(surface.get()));
    cairo_set_source_rgb(cairo.get(), 1, 1, 1);
    cairo_paint(cairo.get());
    cairo_scale(cairo.get(), scale, scale);
    const RsvgRectangle viewport{0, 0, width, height};
    if (rsvg_handle_render_document(handle.get(), cairo.get(), &viewport, &error) == 0)
      fail(path, "picture", "", "could not be drawn: " + take(error));
    write_png(surface.get(), path);
    return;
  }
  const Surface surface(cairo_pdf_surface_create(path.c_str(), width * kPointsPerPixel, height * kPointsPerPixel));
  if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
    fail_to_write(path, cairo_status_to_string(status));
  // A fixed date instead of cairo's today: equal pictures stay equal bytes.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  draw(handle.get(), surface.get(), kPointsPerPixel, width, height, path);
}

}  // namespace ttf::report::drawing
