"""What `analysis/figures.py` can draw of a folder, a module for each kind. Each has `draw(request, medium)`, which hands out
drawings and texts, or raises MissingError where the folder does not hold what it needs."""
