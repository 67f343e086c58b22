"""The report page: one page about one results folder: what went wrong, the table, the curves, the images, and where it all is from."""
