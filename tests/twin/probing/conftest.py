import sys
from pathlib import Path

# the helper module beside this file
sys.path.insert(0, str(Path(__file__).parent))
