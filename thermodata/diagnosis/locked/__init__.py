"""What the locked tests say of a claim or of a user's own choice; each look is counted.

Which of them may be opened, what is foretold of them, and what is withdrawn where they disagree.
"""
