"""Models of the paper: networks over point clouds and boxes, and trees."""
