-- SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
-- SPDX-License-Identifier: Apache-2.0

SDF_GLOBAL_CONSTRAINTS = {
  -- The HTML page that shows what was done.
  report = {
    -- [pixels] Longer side of the pictures of the whole map.
    map_picture_pixels = 1600,
    -- [pixels] Longer side of the picture of a matched pair.
    closure_picture_pixels = 360,
    -- Closures beyond it are listed without a picture. More: a larger page.
    max_closure_pictures = 60,
  },
}

return SDF_GLOBAL_CONSTRAINTS
