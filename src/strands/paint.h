// SPDX-License-Identifier: MIT
// What hair looks like where it is not the same all over a section: colours and thickness that a
// file has, an image that colours the strands by their roots, tips of another colour.
#pragma once

#include "base/params.h"
#include "strands/strands.h"

// A zeroed struct paints nothing: the section's own values hold.
typedef struct Paint {
    float (*color)[4];     // [vertex_count], linear RGB and opacity (a factor), 0..1; owned
    float *thickness;      // [vertex_count], radius over the section's, tips included; owned
    bool colors_from_file; // they are kept as they are, strands do not differ by chance
    uint32_t vertex_count;
} Paint;

// Paints the strands as the parameters say:
//   color       that of color_map at the strand's root (bilinear; u to the right, v up from the
//               lowest row, both wrap around), else the file's with file_colors, else paint_color
//               (colours of maps, files and tips are such as one sees, as params->color is)
//   tip         from 1 - tip_length of the way along (by vertices) colours run to tip_color
//   opacity     the file's with file_opacity, its mean over the strand
//   thickness   the file's with file_thickness over its mean of all vertices; where it is by
//   vertex,
//               tip_ratio is not applied
// Nothing of all that leaves the paint zeroed. RESULT_BAD_INPUT if the image can't be read,
// RESULT_USAGE if there is one but no texture coordinates; RESULT_FAILED when memory is short.
Result paint_create(Paint *paint, const Strands *strands, const SectionParams *params,
                    Error *error);
void paint_destroy(Paint *paint);

// What the file says of its look, whether that is used, and the flag that decides it: "colours used
// (--file-colors), thickness not used (--file-thickness)". False, and "", if it says nothing.
bool paint_describe(const Strands *strands, const SectionParams *params, char *text, size_t size);

// The section's colour, linear RGB: what of white light that crosses a fibre along its diameter is
// left. That is what `melanin` leaves, exp(-2 sigma), sigma the absorption by radius of so much
// eumelanin and pheomelanin (d'Eon et al. 2011); else `transmission`; else that of fibres which
// together show `color` (paint.c). With kajiya, whose colour is what one sees, `color` itself.
void paint_color(const SectionParams *params, float linear[3]);

// The same look with colours as one sees them, which files have: those of kajiya, `color` in place
// of transmission and melanin. What it points to is borrowed.
SectionParams paint_as_seen(const SectionParams *params);

// Fibre radius at the root, metres, > 0, for drawing these strands with this many followers each.
//
// A head carries 100,000 hairs of about 40 um; files hold a few thousand, each of which stands for
// many. So the strands share the image instead: on average 3 lie before a point of the silhouette,
// in the half of the hair that a head or body does not hide. Fibres at random that cover a point 3
// times on average miss it with exp(-3) = 5 % (Poisson). The silhouette is all cells of the three
// views along the axes that hold hair, with 8 to 64 cells along the box's longest side, by the
// number of strands. Twice as many strands are drawn half as thick; the same hair in another unit
// looks the same.
//
// So that fibres still look like fibres, the radius is at most 1/400 of the longest strand; of
// short strands (fur) it may be more, up to 1/12 and 1/300 of the silhouette's side, the root of
// its area. It is at least 1/5000 of the longest strand.
float paint_auto_radius(const Strands *strands, uint32_t followers);

// The section's radius if it says one, else that.
float paint_radius(const SectionParams *params, const Strands *strands, uint32_t followers);
