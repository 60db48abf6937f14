# SPDX-License-Identifier: MIT
"""tractrix.h for ctypes: its structs, and the functions that this module calls. tests/python/test_declarations.py
compares them with the header."""

from __future__ import annotations

import ctypes
from ctypes import CFUNCTYPE, POINTER, Structure, c_bool, c_char_p, c_double, c_float, c_int, c_size_t, c_uint32, c_uint64, c_void_p

RGBA8, RGBA32F, RGBA16 = 0, 1, 2
GUIDES, FOLLOWERS = 0, 1


class Error(Structure):
    _fields_ = [("text", ctypes.c_char * 1024)]


class Sized(Structure):
    """A struct that begins with `size`."""

    def __init__(self, **members: object) -> None:
        super().__init__(size=ctypes.sizeof(type(self)), **members)


class DeviceOptions(Sized):
    _fields_ = [("size", c_size_t), ("name", c_char_p), ("software", c_bool), ("require_hardware", c_bool)]


class Parameter(Structure):
    _fields_ = [("name", c_char_p), ("kind", c_char_p), ("unit", c_char_p), ("help", c_char_p),
                ("default_text", c_char_p), ("choices", c_char_p), ("owner", c_char_p), ("minimum", c_double),
                ("maximum", c_double), ("of_section", c_bool), ("live", c_bool)]


class Strands(Sized):
    _fields_ = [("size", c_size_t), ("metres_per_unit", c_double), ("up_z", c_bool), ("strand_count", c_uint32),
                ("vertices_each", c_uint32), ("sizes", POINTER(c_uint32)), ("position", POINTER(c_float)),
                ("thickness", POINTER(c_float)), ("color", POINTER(c_float)), ("uv", POINTER(c_float))]


class Mesh(Sized):
    _fields_ = [("size", c_size_t), ("metres_per_unit", c_double), ("up_z", c_bool), ("deforms", c_bool),
                ("vertex_count", c_uint32), ("triangle_count", c_uint32), ("position", POINTER(c_float)),
                ("triangle", POINTER(c_uint32))]


class Pose(Structure):
    _fields_ = [("rotation", c_double * 4), ("translation", c_double * 3)]


class Positions(Sized):
    _fields_ = [("size", c_size_t), ("strand_count", c_uint32), ("vertex_count", c_uint32),
                ("sizes", POINTER(c_uint32)), ("position", POINTER(c_float))]


class Image(Sized):
    _fields_ = [("size", c_size_t), ("width", c_int), ("height", c_int), ("format", c_int), ("row_bytes", c_size_t),
                ("pixels", c_void_p)]


class View(Sized):
    _fields_ = [("size", c_size_t), ("world_to_eye", c_float * 16), ("projection", c_float * 16)]


class Limits(Sized):
    _fields_ = [("size", c_size_t), ("pixel_tolerance", c_double), ("max_failing_percent", c_double),
                ("max_flip", c_double), ("pixels_per_degree", c_double), ("max_difference", c_double),
                ("max_local_difference", c_double)]


class Figures(Sized):
    _fields_ = [("size", c_size_t), ("compared", c_uint64), ("failing", c_uint64), ("largest", c_double),
                ("at", c_int * 2), ("rmse", c_double), ("psnr", c_double), ("ssim", c_double), ("flip", c_double),
                ("flip_most", c_double), ("same", c_bool), ("within", c_bool), ("equal", c_bool), ("local_at", c_int * 2),
                ("local_difference", c_double)]


class WriteOptions(Sized):
    _fields_ = [("size", c_size_t), ("half", c_bool)]


class Layers(Sized):
    _fields_ = [("size", c_size_t), ("coverage", POINTER(c_float)), ("depth", POINTER(c_float)), ("tangent", POINTER(c_float)),
                ("strand", POINTER(c_uint32))]


Progress = CFUNCTYPE(c_bool, c_void_p, c_double)
HANDLE = c_void_p
_NEW, _ERROR, _FLOATS = POINTER(HANDLE), POINTER(Error), POINTER(c_float)
_DESTROY = (None, [HANDLE])

# name: (result, arguments)
FUNCTIONS = {
    "tractrix_version_number": (c_uint32, []),
    "tractrix_version": (c_char_p, []),
    "tractrix_set_threads": (None, [c_int]),
    "tractrix_device_open": (c_int, [_NEW, POINTER(DeviceOptions), _ERROR]),
    "tractrix_device_destroy": _DESTROY,
    "tractrix_device_set_progress": (None, [HANDLE, Progress, c_void_p]),
    "tractrix_device_text": (c_char_p, [HANDLE, c_char_p]),
    "tractrix_parameter": (POINTER(Parameter), [c_size_t]),
    "tractrix_scene_create": (c_int, [_NEW, c_char_p, _ERROR]),
    "tractrix_scene_read": (c_int, [_NEW, c_char_p, _ERROR]),
    "tractrix_scene_parse": (c_int, [_NEW, c_char_p, c_char_p, _ERROR]),
    "tractrix_scene_destroy": _DESTROY,
    "tractrix_scene_add_strands": (c_int, [HANDLE, c_char_p, POINTER(Strands), _ERROR]),
    "tractrix_scene_set_mesh": (c_int, [HANDLE, POINTER(Mesh), _ERROR]),
    "tractrix_scene_set_body_mesh": (c_int, [HANDLE, c_uint32, POINTER(Mesh), _ERROR]),
    "tractrix_scene_set": (c_int, [HANDLE, c_int, c_char_p, c_char_p, _ERROR]),
    "tractrix_simulation_create": (c_int, [_NEW, HANDLE, HANDLE, _ERROR]),
    "tractrix_simulation_destroy": _DESTROY,
    "tractrix_simulation_messages": (c_char_p, [HANDLE]),
    "tractrix_simulation_set_section": (c_int, [HANDLE, c_int, c_char_p, c_char_p, _ERROR]),
    "tractrix_simulation_advance": (c_int, [HANDLE, POINTER(Pose), _ERROR]),
    "tractrix_simulation_advance_mesh": (c_int, [HANDLE, _FLOATS, c_uint32, _ERROR]),
    "tractrix_simulation_place_body": (c_int, [HANDLE, c_uint32, POINTER(Pose), _ERROR]),
    "tractrix_simulation_place_body_mesh": (c_int, [HANDLE, c_uint32, _FLOATS, c_uint32, _ERROR]),
    "tractrix_simulation_time": (c_double, [HANDLE]),
    "tractrix_simulation_save": (c_int, [_NEW, HANDLE, _ERROR]),
    "tractrix_simulation_restore": (c_int, [HANDLE, HANDLE, _ERROR]),
    "tractrix_state_bytes": (c_void_p, [HANDLE, POINTER(c_size_t)]),
    "tractrix_state_create": (c_int, [_NEW, c_void_p, c_size_t, _ERROR]),
    "tractrix_state_destroy": _DESTROY,
    "tractrix_simulation_map": (c_int, [HANDLE, c_int, c_int, POINTER(Positions), _ERROR]),
    "tractrix_renderer_create": (c_int, [_NEW, HANDLE, c_int, c_int, c_int, _ERROR]),
    "tractrix_renderer_destroy": _DESTROY,
    "tractrix_render_layers": (c_int, [HANDLE, POINTER(View), POINTER(Image), POINTER(Layers), _ERROR]),
    "tractrix_picture_read": (c_int, [_NEW, c_char_p, _ERROR]),
    "tractrix_picture_image": (POINTER(Image), [HANDLE]),
    "tractrix_picture_destroy": _DESTROY,
    "tractrix_image_write_with": (c_int, [POINTER(Image), c_char_p, POINTER(WriteOptions), _ERROR]),
    "tractrix_compare": (c_int, [POINTER(Figures), _FLOATS, POINTER(Image), POINTER(Image), POINTER(Image),
                                 POINTER(Limits), _ERROR]),
}
