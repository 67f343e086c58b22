"""The numbers by which figures and pages judge, each once. What the program judges by the same measure, it has itself:
a test compares the two."""

CONFIDENCE = 0.95       # of every interval
LEVEL = 0.05            # a comparison whose corrected p is below it is called a change
SLOPE = 0.1             # an interval of a slope that lies further from -1 is flagged: kSlopeTolerance of the program
REFERENCE_FLOOR = 3     # an error within so many times the reference's noise is flagged: kReferenceFloor of the program
