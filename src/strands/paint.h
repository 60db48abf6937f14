// SPDX-License-Identifier: MIT
// The look of hair where it varies within a section: colours and thickness from the file, an image
// that colours strands by their roots, and tips of another colour.
#pragma once

#include "base/params.h"
#include "strands/strands.h"

// A zeroed struct changes nothing; the section's own values apply.
typedef struct Paint {
    float (*color)[4];     // [vertex_count], linear RGB and opacity (a factor), 0..1; owned
    float *thickness;      // [vertex_count] radius divided by the section's, including the tips'
                           // taper; owned
    bool colors_from_file; // colours are kept exactly, without random variation between strands
    uint32_t vertex_count;
} Paint;

// Paints the strands according to the parameters:
//   color       color_map at the strand's root, if given (bilinear; u to the right, v up from the
// lowest row, both
//               repeat); otherwise the file's colour with file_colors; otherwise paint_color.
//               Colours of maps, files and tips are apparent colours, like params->color.
//   tip         from 1 - tip_length of the strand on (by vertices), colours blend to tip_color
//   opacity     the file's with file_opacity, averaged over the strand
//   thickness   the file's with file_thickness, divided by its mean over all vertices; tip_ratio is
//               not applied to a thickness by vertex
// If none of these applies, the paint stays zeroed. RESULT_BAD_INPUT if the image cannot be read,
// RESULT_USAGE if there is an image but no texture coordinates, RESULT_FAILED when memory is short.
Result paint_create(Paint *paint, const Strands *strands, const SectionParams *params,
                    Error *error);
void paint_destroy(Paint *paint);

// Describes the look that the file contains, whether it is used, and the flag that decides:
// "colours used (--file-colors), thickness not used (--file-thickness)". False and "" if the file
// contains none.
bool paint_describe(const Strands *strands, const SectionParams *params, char *text, size_t size);

// The section's colour, linear RGB: the share of white light that passes through a fibre along its
// diameter. It results from `melanin` as exp(-2 sigma), where sigma is the absorption per radius of
// that much eumelanin and pheomelanin (d'Eon et al. 2011); otherwise from `transmission`; otherwise
// from the apparent colour `color` (paint.c). With kajiya it is `color` itself, because that model
// uses the apparent colour.
void paint_color(const SectionParams *params, float linear[3]);

// The same look with apparent colours, as files store them: kajiya shading, and `color` instead of
// transmission and melanin. Pointers are borrowed.
SectionParams paint_as_seen(const SectionParams *params);

// The radius of a fibre at the root (metres, > 0) for drawing these strands with `followers`
// followers each.
//
// A head has 100,000 hairs of about 40 um; a file has a few thousand strands, each of which stands
// for many hairs. So the radius is chosen by coverage: on average, 3 fibres lie in front of a point
// of the silhouette, counting the half of the hair that a head or body does not hide. Randomly
// placed fibres that cover a point 3 times on average miss it with probability exp(-3) = 5 %
// (Poisson). The silhouette consists of the cells that contain hair in three views along the axes,
// with 8 to 64 cells along the box's longest side, depending on the number of strands. Twice as
// many strands are drawn half as thick, and the unit of the hair does not matter.
//
// So that fibres still look like fibres, the radius is at most 1/400 of the longest strand. For
// short strands (fur) it may be larger, up to 1/12 of the longest strand and 1/300 of the
// silhouette's side (the square root of its area). It is at least 1/5000 of the longest strand.
float paint_auto_radius(const Strands *strands, uint32_t followers);

// Half the mean width of the file's vertices, in metres, if the fibres are drawn with these widths:
// the section has no radius of its own and uses the file's thickness, and the widths are those of
// hair (below a fifth of the longest strand). Otherwise 0.
float paint_file_radius(const SectionParams *params, const Strands *strands);

// The radius that is drawn: width_scale times the section's radius if it has one, otherwise
// paint_file_radius, otherwise paint_auto_radius.
float paint_radius(const SectionParams *params, const Strands *strands, uint32_t followers);
