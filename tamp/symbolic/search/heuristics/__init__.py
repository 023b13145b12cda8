"""Heuristics of the search: delete relaxation (FF, hadd, hmax), landmarks, LM-cut."""
